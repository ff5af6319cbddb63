#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace qddot {
inline namespace tests {

// Spoils texts, the same ones in the same way for the same seed.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

  // `text` with one to eight changes. Bytes, ranges, lines, words and numbers are altered,
  // repeated, swapped or left out; parts of `other`, nesting and invalid bytes are inserted.
  std::string spoiled(std::string text, const std::string& other) {
    constexpr std::size_t longest = 20'000;
    // Half of them with a single change, so that more than a few remain readable.
    for (std::size_t changes = 1 + below(below(2) ? 1 : 8); changes > 0; --changes) {
      switch (below(4)) {
        case 0:
          change_bytes(text, other);
          break;
        case 1:
          change_words(text);
          break;
        case 2:
          change_lines(text);
          break;
        default:
          text.insert(below(text.size() + 1), insertion());
      }
      text.resize(std::min(text.size(), longest));
    }
    return text;
  }

 private:
  struct Range {
    std::size_t start, size;
  };

  // Lists, whose parts stand between bars.
  static constexpr std::string_view numbers =
      "-1|0|-0|-0.0|1|2|3|nan|-nan|inf|-inf|1e308|-1e308|1.7976931348623157e308|1e309|1e-320|"
      "5e-324|1e-400|99999999999999999999|-99999999999999999999|9223372036854775807|"
      "-9223372036854775808|18446744073709551615|4294967296|2147483648|1000000000|1000|0x10|0b11|"
      "0o7|1_0|01|1.|.5|1e|2024-01-01T00:00:00Z";
  static constexpr std::string_view words =
      "nodes|springs|[[nodes]]\n|[[springs]]\n|[mesh]\n|[generator]\n|[[mesh.pin]]\n|mass = 1\n|"
      "pinned = true\n|quartic = 1\n|rest_length = 0.5\n|start = \"equilibrium\"\n|"
      "bending_stiffness = 1\n|dimension = 1\n|[]|{}|\"\"\"|'''|\\u0000|\\n|\\UFFFFFFFF|\r\n|#|=|"
      "$Nodes\n|$EndNodes\n|$Elements\n|$EndElements\n|4.1|2.2|Vertices|Triangles|Dimension 2\n|"
      "f 1 2 3\n|v 1 2 3\n";
  static constexpr std::string_view not_text =
      "\xff|\x80|\xc3\x28|\xed\xa0\x80|\xf8\x88\x80\x80\x80|\xef\xbb\xbf|\xc2\x85|\xf4\x90\x80\x80";
  static constexpr std::string_view nestings = "[|{a=|a.|[[|[a.|{a.b=";

  // The parts of a text between bytes of `separators`: its words or its lines.
  static std::vector<Range> parts(std::string_view text, std::string_view separators) {
    std::vector<Range> all;
    for (std::size_t start = 0; start < text.size();) {
      const std::size_t end = std::min(text.find_first_of(separators, start), text.size());
      if (end > start) all.push_back({start, end - start});
      start = end + 1;
    }
    return all;
  }

  static std::vector<Range> number_words(std::string_view text) {
    auto all = parts(text, " \n\t,[]{}=/\"");
    std::erase_if(all, [&](const Range& word) {
      return std::string_view("+-.0123456789").find(text[word.start]) == std::string_view::npos;
    });
    return all;
  }

  std::string_view one_of(std::string_view list) {
    const auto all = parts(list, "|");
    const Range chosen = all[below(all.size())];
    return list.substr(chosen.start, chosen.size);
  }

  void change_bytes(std::string& text, const std::string& other) {
    const std::size_t at = below(text.size() + 1), length = below(below(4) ? 12 : 300);
    switch (below(6)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        return;
      case 1:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        return;
      case 2:
        text.erase(at, length);
        return;
      case 3:
        text.insert(at, text.substr(below(text.size() + 1), length));
        return;
      case 4:
        text.insert(at, other.substr(below(other.size() + 1), length));
        return;
      default:  // the start of the one, the end of the other
        text = text.substr(0, at) + other.substr(below(other.size() + 1));
    }
  }

  static void swap_parts(std::string& text, Range a, Range b) {
    if (a.start > b.start) std::swap(a, b);
    if (a.start + a.size > b.start) return;
    const std::string first = text.substr(a.start, a.size), second = text.substr(b.start, b.size);
    text.replace(b.start, b.size, first);
    text.replace(a.start, a.size, second);
  }

  void change_words(std::string& text) {
    const auto all = below(2) ? number_words(text) : parts(text, " \n\t,[]{}=");
    if (all.empty()) return;
    const Range word = all[below(all.size())], second = all[below(all.size())];
    switch (below(4)) {
      case 0:
        return swap_parts(text, word, second);
      case 1:
        text.replace(word.start, word.size, text.substr(second.start, second.size));
        return;
      default:
        text.replace(word.start, word.size, one_of(numbers));
    }
  }

  void change_lines(std::string& text) {
    const auto all = parts(text, "\n");
    if (all.empty()) return;
    const Range line = all[below(all.size())], second = all[below(all.size())];
    const std::string copy = text.substr(line.start, line.size) + "\n";
    switch (below(4)) {
      case 0:
        return swap_parts(text, line, second);
      case 1:
        text.erase(line.start, line.size + 1);
        return;
      case 2:
        text.insert(second.start, copy);
        return;
      default:
        for (std::size_t times = below(below(8) ? 6 : 200); times > 0; --times)
          text.insert(line.start, copy);
    }
  }

  std::string insertion() {
    switch (below(8)) {
      case 0:
        return std::string(one_of(not_text));
      case 1: {
        const std::string_view nesting = one_of(nestings);
        std::string deep;
        for (std::size_t depth = below(below(8) ? 8 : 4000); depth > 0; --depth) deep += nesting;
        return deep;
      }
      case 2:
        return std::string(one_of(numbers));
      case 3:
        return std::string(1, static_cast<char>(below(256)));
      default:
        return std::string(one_of(words));
    }
  }

  std::mt19937_64 random_;
};

}  // namespace tests
}  // namespace qddot
