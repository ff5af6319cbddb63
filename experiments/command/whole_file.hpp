#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>

namespace qddot::command {

// A result could not be written, as the disk is full or the like; names the file and the reason.
class CannotWrite : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A file that appears whole or not at all: written beside its place under another name (see
// unfinished.hpp), renamed by commit(), removed if it is destroyed before.
class WholeFile {
 public:
  // Throws InvalidInput if the place cannot be written, or may not: see require_replaceable, which
  // is given `beginning` and `sidecar`.
  explicit WholeFile(const std::string& path, const std::string& beginning = {},
                     const std::string& sidecar = {});
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  const std::string& path() const { return path_; }
  // The name that it is written under, for a library that opens files itself.
  const std::string& unfinished_path() const { return beside_; }
  // All throw CannotWrite.
  void write(std::string_view text);
  // Puts this in the place of the first bytes of what was written; what comes goes on at the end.
  void overwrite_beginning(std::string_view text);
  // Nothing more is to be written: the disk holds it all.
  void complete();
  // Gives it its name, after complete().
  void commit();

 private:
  [[noreturn]] void fail(int error) const;

  std::string path_, beside_;
  std::FILE* file_;  // none once it is complete
  int lock_ = -1;    // held until the file has its name, so that nobody takes it for a stale one
};

}  // namespace qddot::command
