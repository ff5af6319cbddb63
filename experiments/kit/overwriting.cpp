#include "experiments/kit/overwriting.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
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

}  // namespace qddot::inline kit
