#include "qddot/scene/text_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"

namespace qddot {

std::string read_text(const std::string& path) {
  const auto refuse = [&](const std::string& what) {
    throw InvalidInput(
        fmt::format("{}: {}; allowed are readable regular files of up to 256 MB", path, what));
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) refuse("this is a folder");
  // A pipe may never be written to, and a device may never end.
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    refuse("this is a pipe, a socket or a device");
  std::ifstream in(path, std::ios::binary);
  if (!in) refuse(fmt::format("the file cannot be opened ({})", std::strerror(errno)));

  std::string text;
  // The file may still grow.
  if (const auto size = std::filesystem::file_size(path, ignored); !ignored && size <= most_bytes)
    text.reserve(size);
  std::array<char, 65536> block;
  while (in.read(block.data(), block.size()), in.gcount() > 0) {
    text.append(block.data(), static_cast<std::size_t>(in.gcount()));
    if (text.size() > most_bytes) refuse("the file holds more than 256 MB");
  }
  if (in.bad()) refuse("the file cannot be read to its end");
  return text;
}

std::string shown(std::string_view text, std::size_t most) {
  std::string line(text.substr(0, most));
  std::replace(line.begin(), line.end(), '\n', ' ');
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text.size() > most ? line + "..." : line;
}

}  // namespace qddot
