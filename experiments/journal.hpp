#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace qddot {

// What a study has measured so far, in a file that outlives the process: each piece is written with
// one call as it comes, so that a process that is killed loses no more than the piece at hand.
// The file: a record holding the key, then one a piece, [name, value]; a record is its size and its
// CRC-32 (four bytes each, little-endian) and CBOR (RFC 8949), which keeps every double. Reading
// ends at the first record that is not whole. Thread-safe.
class Journal {
 public:
  // Starts an empty one, or, if `goes_on`, goes on with the pieces of the file that is there.
  // Throws InvalidInput if another process is writing it, if its key is another one, which is then
  // named, or if it cannot be written.
  Journal(const std::string& path, const nlohmann::json& key, bool goes_on);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // How many pieces there are.
  std::size_t size() const;
  std::optional<nlohmann::json> find(const std::string& name) const;
  // Throws CannotWrite.
  void keep(const std::string& name, const nlohmann::json& value);
  // Removes the file: the study is complete.
  void remove();

  // How many pieces the file holds; none where there is no journal.
  static std::size_t pieces_in(const std::string& path);

 private:
  void append(const nlohmann::json& record);

  std::string path_;
  int file_ = -1;
  std::map<std::string, nlohmann::json> pieces_;
  mutable std::mutex mutex_;
};

}  // namespace qddot
