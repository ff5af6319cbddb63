#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace qddot {

// The largest size of a file that is read: 256 MB.
inline constexpr std::size_t most_bytes = 256'000'000;

// The whole text of a file that the user named. Throws InvalidInput, in a sentence that starts with
// `path`, if it is no regular file, cannot be read or is too large.
std::string read_text(const std::string& path);

// Gives the text of a file as read_text does; its files need not be on a disk.
using TextSource = std::function<std::string(const std::string& path)>;

// `text` made fit for a one-line message: at most `most` characters, with '?' for unprintable ones.
std::string shown(std::string_view text, std::size_t most = 60);

}  // namespace qddot
