#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>

namespace qddot::inline kit {

// The files that outputs may replace. A file that the program has read is never replaced, and a
// file that qddot did not write only with --force.

// Protects a file that was read: no output may replace it from now on.
void protect_input(const std::string& path);
// Allows outputs to replace files that qddot did not write.
void allow_replacing();

// Throws InvalidInput, which names the path, if an output may not replace that file. Replaceable
// are empty files and those that begin with `beginning`, a table's own header row. So are files
// that qddot wrote, as their sidecar `sidecar` or their own text says.
void require_replaceable(const std::string& path, const std::string& beginning = {},
                         const std::string& sidecar = {});

// The text after a line, a comment in TOML, by which qddot recognises it as its own while nobody
// changes it.
std::string signed_text(const std::string& text);

// Thrown if a result cannot be written, as on a full disk; names the file and the reason.
class CannotWrite : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A file that appears whole or not at all. It is written under another name in the same folder,
// X.PID.part, and renamed by commit(), or removed if it is destroyed before.
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

// Removes all files of this process that have not appeared, before it ends.
void remove_unfinished();

// The 64-bit FNV-1a hash of a text, as 16 hexadecimal digits.
std::string text_hash(const std::string& text);

}  // namespace qddot::inline kit
