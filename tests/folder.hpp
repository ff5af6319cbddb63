#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>

namespace qddot {
inline namespace tests {

// The names of what stands in a folder, in order and each followed by a space.
inline std::string listing(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  std::string all;
  for (const std::string& name : names) all += name + ' ';
  return all;
}

inline std::string read_all(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A fresh folder for a test's files, gone at its end.
class Folder {
 public:
  Folder() { std::filesystem::create_directories(path_); }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string path() const { return path_.string(); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return *this / name;
  }
  std::string listing() const { return qddot::listing(path()); }

 private:
  std::filesystem::path path_ = std::filesystem::temp_directory_path() /
                                fmt::format("qddot_test_{}_{:x}", getpid(), std::random_device{}());
};

}  // namespace tests
}  // namespace qddot
