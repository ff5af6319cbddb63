#include "experiments/whole_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "src/scene/invalid_input.hpp"

namespace qddot {

WholeFile::WholeFile(const std::string& path)
    : path_(path), beside_(fmt::format("{}.{}.part", path, ::getpid())) {
  if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path)) {
    throw InvalidInput(
        fmt::format("{}: is a folder or a device; allowed is the name of a file", path));
  }
  file_ = std::fopen(beside_.c_str(), "w");
  if (!file_) {
    throw InvalidInput(
        fmt::format("{}: cannot be written ({}); allowed is a file in a folder that "
                    "exists and can be written",
                    path, std::strerror(errno)));
  }
}

WholeFile::~WholeFile() {
  if (!file_) return;
  std::fclose(file_);
  std::remove(beside_.c_str());
}

void WholeFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) {
    throw std::runtime_error(fmt::format("{}: {}", path_, std::strerror(errno)));
  }
}

void WholeFile::commit() {
  std::FILE* file = std::exchange(file_, nullptr);
  if (std::fclose(file) != 0 || std::rename(beside_.c_str(), path_.c_str()) != 0) {
    const std::string reason = std::strerror(errno);
    std::remove(beside_.c_str());
    throw std::runtime_error(fmt::format("{}: {}", path_, reason));
  }
}

}  // namespace qddot
