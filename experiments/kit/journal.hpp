#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace qddot::inline kit {

// The file of all pieces that a study has measured so far. Each piece is written with one call when
// it is measured, so that a killed process loses only the piece in progress.
// The file begins with the line "qddot journal 1" and a record of the key; a record [name, value]
// for each piece follows. A record is its size, its CRC-32 (four bytes each, little-endian) and its
// content in CBOR (RFC 8949), which keeps every double. Reading ends at the first incomplete
// record. Thread-safe.
class Journal {
 public:
  // The contents of a journal. `is_own`: the file is a journal, or the beginning of one.
  struct Contents {
    bool is_own = false;
    nlohmann::json key{};
    std::map<std::string, nlohmann::json> pieces{};
    std::size_t whole = 0;  // bytes up to the end of the last whole record
  };
  // Reads a journal, even while another process writes it. A missing file has no contents.
  static Contents read(const std::string& path);

  // Starts an empty journal or, if `goes_on`, continues the existing one with its pieces. Throws
  // InvalidInput if
  // - another process writes the file,
  // - it is to continue a journal with another key; the message names the difference,
  // - the file is no journal and may not be replaced,
  // - the file cannot be written.
  Journal(const std::string& path, const nlohmann::json& key, bool goes_on);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // The number of pieces.
  std::size_t size() const;
  // The number of pieces of the former file that an empty journal replaced.
  std::size_t dropped() const { return dropped_; }
  std::optional<nlohmann::json> find(const std::string& name) const;
  // Throws CannotWrite.
  void keep(const std::string& name, const nlohmann::json& value);
  // Removes the file: the study is complete.
  void remove();

 private:
  // Writes the bytes and the record at once.
  void append(std::vector<std::uint8_t> bytes, const nlohmann::json& record);

  std::string path_;
  int file_ = -1;
  std::map<std::string, nlohmann::json> pieces_;
  std::size_t dropped_ = 0;
  mutable std::mutex mutex_;
};

// The entry in which two keys differ, with both values, in words; empty if they are equal.
std::string difference(const nlohmann::json& there, const nlohmann::json& asked);

}  // namespace qddot::inline kit
