#pragma once

#include <cstdint>
#include <random>
#include <string>

namespace qddot {
inline namespace tests {

// Spoils texts, the same ones in the same way for the same seed.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }
  // `text` with one to eight changes. Bytes, ranges, lines, words and numbers are altered,
  // repeated, swapped or left out; parts of `other`, nesting and invalid bytes are inserted.
  std::string spoiled(std::string text, const std::string& other);

 private:
  void change(std::string& text, const std::string& other);
  void change_bytes(std::string& text, const std::string& other);
  void change_words(std::string& text);
  void change_lines(std::string& text);
  std::string insertion();

  std::mt19937_64 random_;
};

}  // namespace tests
}  // namespace qddot
