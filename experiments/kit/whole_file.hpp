#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>

namespace qddot::inline kit {

// Thrown if a result cannot be written, as on a full disk; names the file and the reason.
class CannotWrite : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A file that appears whole or not at all. It is written under another name in the same folder (see
// unfinished.hpp) and renamed by commit(), or removed if it is destroyed before.
class WholeFile {
 public:
  // Throws InvalidInput if the file cannot be written, or may not be replaced (see
  // require_replaceable for `beginning` and `sidecar`).
  explicit WholeFile(const std::string& path, const std::string& beginning = {},
                     const std::string& sidecar = {});
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  const std::string& path() const { return path_; }
  // The name under which it is written, for a library that opens files itself.
  const std::string& unfinished_path() const { return beside_; }
  // All throw CannotWrite.
  void write(std::string_view text);
  // Replaces the first bytes of the file; later writes go on at the end.
  void overwrite_beginning(std::string_view text);
  // Writes all data to the disk; nothing may follow.
  void complete();
  // Gives the file its name, after complete().
  void commit();

 private:
  [[noreturn]] void fail(int error) const;

  std::string path_, beside_;
  std::FILE* file_;  // null once it is complete
  int lock_ = -1;    // held until the file has its name, so that it is not taken for stale
};

// The 64-bit FNV-1a hash of a text, as 16 hexadecimal digits.
std::string text_hash(const std::string& text);

}  // namespace qddot::inline kit
