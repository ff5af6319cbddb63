#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace qddot {

// How large a file that is read may be: 256 MB.
inline constexpr std::size_t most_bytes = 256'000'000;

// The whole of a file that the user named. Throws InvalidInput, in a sentence that starts with
// `path`, where it is no regular file, cannot be read or is too large.
std::string read_text(const std::string& path);

// Gives the text of a file as read_text does, which may keep its files elsewhere than on a disk.
using TextSource = std::function<std::string(const std::string& path)>;

// `text` made fit for a one-line message: at most `most` characters, unprintable ones as '?'.
std::string shown(std::string_view text, std::size_t most = 60);

}  // namespace qddot
