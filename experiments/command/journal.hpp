#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace qddot::command {

// What a study has measured so far, in a file that outlives the process: each piece is written with
// one call as it comes, so that a process that is killed loses no more than the piece at hand.
// The file: the line "qddot journal 1", a record holding the key, then one a piece, [name, value];
// a record is its size and its CRC-32 (four bytes each, little-endian) and CBOR (RFC 8949), which
// keeps every double. Reading ends at the first record that is not whole. Thread-safe.
class Journal {
 public:
  // What a file of that kind holds. `is_own`: it is one, or the beginning of one.
  struct Contents {
    bool is_own = false;
    nlohmann::json key{};
    std::map<std::string, nlohmann::json> pieces{};
    std::size_t whole = 0;  // bytes up to the end of the last whole record
  };
  // Reads it, whoever may be writing it; nothing is whole in a file that is not there.
  static Contents read(const std::string& path);

  // Starts an empty one, or, if `goes_on`, goes on with the pieces of the file that is there.
  // Throws InvalidInput if another process is writing it, if it is to go on and its key is another
  // one, which is then named, if it is no journal and may not be replaced, or if it cannot be
  // written.
  Journal(const std::string& path, const nlohmann::json& key, bool goes_on);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // How many pieces there are.
  std::size_t size() const;
  // How many there were before it was started as an empty one.
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

// In which entry two keys differ, with both values, in words; empty where they do not.
std::string difference(const nlohmann::json& there, const nlohmann::json& asked);

}  // namespace qddot::command
