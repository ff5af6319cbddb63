#include "experiments/kit/unfinished.hpp"

#include <cctype>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <mutex>
#include <set>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

namespace qddot::inline kit {
namespace {

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

}  // namespace

std::string unfinished_name(const std::string& path) {
  return fmt::format("{}.{}.part", path, ::getpid());
}

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

void forget_unfinished(const std::string& name) {
  const std::lock_guard lock(mutex());
  names().erase(name);
}

void remove_unfinished() {
  mutex().lock();  // for ever: no other thread may begin a file before the process ends
  for (const std::string& name : names()) std::remove(name.c_str());
}

}  // namespace qddot::inline kit
