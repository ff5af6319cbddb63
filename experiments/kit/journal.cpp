#include "experiments/kit/journal.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <string_view>
#include <sys/file.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include <boost/crc.hpp>
#include <fmt/format.h>

#include "experiments/kit/whole_file.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::string_view signature = "qddot journal 1\n";
constexpr std::size_t bytes_of_head = 8;  // of a record

std::uint32_t checksum(const std::uint8_t* bytes, std::size_t size) {
  boost::crc_32_type sum;
  sum.process_bytes(bytes, size);
  return sum.checksum();
}

void put(Bytes& bytes, std::uint32_t x) {
  for (int k = 0; k < 4; ++k) bytes.push_back(static_cast<std::uint8_t>(x >> (8 * k)));
}

std::uint32_t get(const std::uint8_t* bytes) {
  std::uint32_t x = 0;
  for (int k = 0; k < 4; ++k) x |= std::uint32_t{bytes[k]} << (8 * k);
  return x;
}

// Text that is no UTF-8 is mended.
std::string json_in_words(const nlohmann::json& json) {
  return json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

// False where another process writes it; one that only looks whether somebody does holds it for an
// instant. Some file systems have no locks.
bool lock(int file) {
  constexpr int tries = 10;
  for (int i = 0; i < tries; ++i) {
    if (::flock(file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

}  // namespace

Journal::Contents Journal::read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const Bytes bytes{std::istreambuf_iterator<char>(file), {}};
  const std::string_view beginning(reinterpret_cast<const char*>(bytes.data()),
                                   std::min(bytes.size(), signature.size()));
  Contents contents{.is_own = signature.starts_with(beginning)};
  if (!contents.is_own) return contents;
  for (std::size_t at = signature.size(); at + bytes_of_head <= bytes.size();) {
    const std::size_t size = get(&bytes[at]);
    const std::uint8_t* record = bytes.data() + at + bytes_of_head;
    if (size > bytes.size() - at - bytes_of_head || get(&bytes[at + 4]) != checksum(record, size))
      break;
    nlohmann::json json = nlohmann::json::from_cbor(record, record + size, true, false);
    if (json.is_discarded()) break;
    if (contents.whole == 0) {
      contents.key = std::move(json);
    } else {
      contents.pieces[json.at(0)] = std::move(json.at(1));
    }
    at += bytes_of_head + size;
    contents.whole = at;
  }
  return contents;
}

std::string difference(const nlohmann::json& there, const nlohmann::json& asked) {
  for (const auto& [name, value] : asked.items()) {
    const nlohmann::json other = there.is_object() ? there.value(name, nlohmann::json()) : nullptr;
    if (other == value) continue;
    if (value.is_object() && other.is_object()) return kit::difference(other, value);
    return fmt::format("its {} is {} instead of {}", name, json_in_words(other),
                       json_in_words(value));
  }
  for (const auto& [name, value] : there.items()) {
    if (!asked.contains(name)) return fmt::format("it was made with {}", name);
  }
  return "";
}

Journal::Journal(const std::string& path, const nlohmann::json& key, bool goes_on) : path_(path) {
  file_ =
      ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
  if (file_ < 0) {
    throw InvalidInput(fmt::format("{}: cannot be written ({}); allowed is a folder that can be",
                                   path, std::strerror(errno)));
  }
  try {
    struct stat status {};
    if (::fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) {
      throw InvalidInput(fmt::format("{}: is no file; allowed is another folder", path));
    }
    if (!lock(file_)) {
      throw InvalidInput(fmt::format(
          "{}: another process is writing it; allowed is another folder, or to wait", path));
    }
    Contents contents = read(path);
    if (!contents.is_own) require_replaceable(path);
    if (goes_on && contents.whole > 0 && contents.key != key) {
      throw InvalidInput(
          fmt::format("--resume: {} is of another study: {}; allowed are the same scene, code and "
                      "options, or no --resume",
                      path, difference(contents.key, key)));
    }
    if (goes_on) {
      pieces_ = std::move(contents.pieces);
    } else {
      dropped_ = contents.pieces.size();
      contents.whole = 0;
    }
    if (::ftruncate(file_, static_cast<off_t>(contents.whole)) != 0)
      throw CannotWrite(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
    if (contents.whole == 0) append({signature.begin(), signature.end()}, key);
  } catch (...) {
    ::close(file_);
    throw;
  }
}

Journal::~Journal() { ::close(file_); }

std::size_t Journal::size() const {
  const std::lock_guard lock(mutex_);
  return pieces_.size();
}

std::optional<nlohmann::json> Journal::find(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = pieces_.find(name);
  return found == pieces_.end() ? std::nullopt : std::optional(found->second);
}

void Journal::keep(const std::string& name, const nlohmann::json& value) {
  const std::lock_guard lock(mutex_);
  append({}, {name, value});
  pieces_[name] = value;
}

void Journal::append(std::vector<std::uint8_t> bytes, const nlohmann::json& record) {
  const Bytes cbor = nlohmann::json::to_cbor(record);
  put(bytes, static_cast<std::uint32_t>(cbor.size()));
  put(bytes, checksum(cbor.data(), cbor.size()));
  bytes.insert(bytes.end(), cbor.begin(), cbor.end());
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t written = ::write(file_, bytes.data() + at, bytes.size() - at);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0)
      throw CannotWrite(fmt::format("{}: cannot be written: {}", path_, std::strerror(errno)));
    at += static_cast<std::size_t>(written);
  }
}

void Journal::remove() { ::unlink(path_.c_str()); }

}  // namespace qddot::inline kit
