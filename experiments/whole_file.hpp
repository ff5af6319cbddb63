#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace qddot {

// A file that appears whole or not at all: written beside its place under another name, renamed by
// commit(), removed if it is destroyed before.
class WholeFile {
 public:
  // Throws InvalidInput if the place cannot be written.
  explicit WholeFile(const std::string& path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  const std::string& path() const { return path_; }
  // Throws std::runtime_error if the disk is full or the like.
  void write(std::string_view text);
  void commit();

 private:
  std::string path_, beside_;
  std::FILE* file_;
};

}  // namespace qddot
