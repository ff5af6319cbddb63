#include "experiments/kit/whole_file.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <set>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include <boost/crc.hpp>
#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {
namespace {

struct Rules {
  std::vector<std::string> inputs;
  bool may_replace = false;
};

Rules& rules() {
  static Rules all;
  return all;
}

// Up to so many bytes of the file's beginning.
std::string beginning_of(const std::string& path, std::size_t most) {
  std::string text(most, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(text.data(), static_cast<std::streamsize>(most));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return text;
}

// Whether it is one of qddot's JSON files: each contains the hash of the program's sources.
bool is_own_json(const std::string& path) {
  constexpr std::size_t longest_beginning = 1 << 20;  // even with a long command line
  const std::string text = beginning_of(path, longest_beginning);
  return text.starts_with('{') && (text.find("\"source_hash\"") != text.npos ||
                                   text.find("\"certified_position\"") != text.npos);
}

std::string signature_of(std::string_view text) {
  boost::crc_32_type sum;
  sum.process_bytes(text.data(), text.size());
  return fmt::format("# Written by qddot; checksum of what follows: {:08x}\n", sum.checksum());
}

bool is_signed(const std::string& path) {
  const std::size_t length = signature_of("").size();
  const std::string signature = beginning_of(path, length);
  if (!signature.starts_with("# Written by qddot")) return false;
  std::error_code error;
  const std::string text = beginning_of(path, std::filesystem::file_size(path, error));
  return text.starts_with(signature_of(std::string_view(text).substr(length)));
}

bool is_own(const std::string& path, const std::string& beginning, const std::string& sidecar) {
  std::error_code error;
  if (std::filesystem::file_size(path, error) == 0 && !error) return true;
  if (!beginning.empty() && beginning_of(path, beginning.size()) == beginning) return true;
  return (!sidecar.empty() && is_own_json(sidecar)) || is_own_json(path) || is_signed(path);
}

}  // namespace

std::string signed_text(const std::string& text) { return signature_of(text) + text; }

void protect_input(const std::string& path) { rules().inputs.push_back(path); }

void allow_replacing() { rules().may_replace = true; }

void require_replaceable(const std::string& path, const std::string& beginning,
                         const std::string& sidecar) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return;
  for (const std::string& input : rules().inputs) {
    if (!std::filesystem::equivalent(path, input, error) || error) continue;
    throw InvalidInput(fmt::format(
        "{}: this file was read, so nothing may be written there; allowed is another name", path));
  }
  if (!std::filesystem::is_regular_file(path, error)) {
    throw InvalidInput(
        fmt::format("{}: is a folder or a device; allowed is the name of a file", path));
  }
  if (rules().may_replace || is_own(path, beginning, sidecar)) return;
  throw InvalidInput(fmt::format(
      "{}: this file stands there and is not one that qddot wrote; allowed are other names, or "
      "--force to replace it",
      path));
}

namespace {

// Files that are being written, X.PID.part beside their final names X. Each is locked (flock) by
// the process that writes it; a file without a lock is stale.
std::mutex& mutex() {
  static std::mutex one;
  return one;
}

std::set<std::string>& names() {
  static std::set<std::string> all;
  return all;
}

// Whether it is X.PID.part.
bool is_unfinished(const std::string& name) {
  constexpr std::string_view ending = ".part";
  if (!name.ends_with(ending)) return false;
  const std::size_t end = name.size() - ending.size();
  std::size_t start = end;
  while (start > 0 && std::isdigit(static_cast<unsigned char>(name[start - 1]))) --start;
  return start < end && start > 1 && name[start - 1] == '.';
}

// Removes the file unless some process holds its lock.
void remove_if_stale(const std::string& name) {
  const int file = ::open(name.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0) return;
  if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(name.c_str());
  ::close(file);
}

void remove_stale(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error), end;
  for (; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().string();
    if (!is_unfinished(entry->path().filename().string())) continue;
    std::error_code ignored;
    if (entry->is_regular_file(ignored) && !entry->is_symlink(ignored)) remove_if_stale(name);
  }
}

// The name of the file that is written beside the place `path`.
std::string unfinished_name(const std::string& path) {
  return fmt::format("{}.{}.part", path, ::getpid());
}

// Opens that file, empty, locks it and registers it. Returns a negative number, with errno set, if
// that fails. Removes stale files in the same folder.
int open_unfinished(const std::string& path) {
  const std::lock_guard lock(mutex());
  const auto folder = std::filesystem::path(path).parent_path();
  remove_stale(folder.empty() ? std::filesystem::path(".") : folder);
  const std::string name = unfinished_name(path);
  for (;;) {
    const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) return file;
    ::flock(file, LOCK_EX | LOCK_NB);
    struct stat status {};
    if (::fstat(file, &status) == 0 && status.st_nlink > 0) {
      names().insert(name);
      return file;
    }
    ::close(file);  // another process took it for a stale one before it was locked
  }
}

// Removes the name from the register: the file was renamed or removed.
void forget_unfinished(const std::string& name) {
  const std::lock_guard lock(mutex());
  names().erase(name);
}

}  // namespace

void remove_unfinished() {
  mutex().lock();  // for ever: no other thread may begin a file before the process ends
  for (const std::string& name : names()) std::remove(name.c_str());
}

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
