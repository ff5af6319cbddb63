#include "experiments/kit/whole_file.hpp"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "experiments/kit/overwriting.hpp"
#include "experiments/kit/unfinished.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {

WholeFile::WholeFile(const std::string& path, const std::string& beginning,
                     const std::string& sidecar)
    : path_(path), beside_(unfinished_name(path)) {
  require_replaceable(path, beginning, sidecar);
  const int file = open_unfinished(path);
  file_ = file < 0 ? nullptr : ::fdopen(file, "w");
  if (!file_) {
    throw InvalidInput(
        fmt::format("{}: cannot be written ({}); allowed is a file in a folder that "
                    "exists and can be written",
                    path, std::strerror(errno)));
  }
}

WholeFile::~WholeFile() {
  if (!beside_.empty()) {
    std::remove(beside_.c_str());
    forget_unfinished(beside_);
  }
  if (file_) std::fclose(file_);
  if (lock_ >= 0) ::close(lock_);
}

void WholeFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail(errno);
}

void WholeFile::overwrite_beginning(std::string_view text) {
  if (std::fseek(file_, 0, SEEK_SET) != 0) fail(errno);
  write(text);
  if (std::fseek(file_, 0, SEEK_END) != 0) fail(errno);
}

void WholeFile::complete() {
  if (!file_) return;
  lock_ = ::dup(::fileno(file_));
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail(errno);
}

void WholeFile::commit() {
  complete();
  const bool has_name = std::rename(beside_.c_str(), path_.c_str()) == 0;
  const int error = errno;
  if (!has_name) std::remove(beside_.c_str());
  forget_unfinished(beside_);
  beside_.clear();
  if (!has_name) fail(error);
}

void WholeFile::fail(int error) const {
  throw CannotWrite(fmt::format("{}: cannot be written: {}", path_, std::strerror(error)));
}

std::string text_hash(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x00000100000001b3ULL;
  return fmt::format("{:016x}", hash);
}

}  // namespace qddot::inline kit
