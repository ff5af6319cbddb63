#include "experiments/kit/progress_words.hpp"

#include <algorithm>
#include <cstdint>
#include <cwchar>
#include <locale.h>

#include <fmt/format.h>

namespace qddot::inline kit {
namespace {

// The least columns for the present work; the program's name takes only others.
constexpr std::size_t least_of_what = 8;
constexpr const char* between = "  ";

// Has this thread read text as UTF-8 while it lives, whatever the user's locale is: names are.
class Utf8 {
 public:
  Utf8() : utf8_(newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr)) {
    if (utf8_) before_ = uselocale(utf8_);
  }
  ~Utf8() {
    if (!utf8_) return;
    uselocale(before_);
    freelocale(utf8_);
  }
  Utf8(const Utf8&) = delete;
  Utf8& operator=(const Utf8&) = delete;

 private:
  locale_t utf8_, before_{};
};

std::size_t columns_of(const std::string& text) {
  const Utf8 utf8;
  std::size_t columns = 0;
  std::mbstate_t state{};
  for (std::size_t at = 0; at < text.size();) {
    wchar_t c = 0;
    const std::size_t bytes = std::mbrtowc(&c, &text[at], text.size() - at, &state);
    if (bytes == 0 || bytes > text.size() - at) return columns;  // not from in_columns
    columns += static_cast<std::size_t>(std::max(0, ::wcwidth(c)));
    at += bytes;
  }
  return columns;
}

}  // namespace

std::string clock_words(double seconds) {
  constexpr double longest = 1e9;  // [s], beyond which nobody waits
  const auto whole = static_cast<std::int64_t>(std::clamp(seconds, 0.0, longest));
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string in_columns(const std::string& text, std::size_t columns) {
  const Utf8 utf8;
  std::string cut;
  std::size_t taken = 0;
  std::mbstate_t state{};
  for (std::size_t at = 0; at < text.size();) {
    wchar_t c = 0;
    std::size_t bytes = std::mbrtowc(&c, &text[at], text.size() - at, &state);
    const bool is_text = bytes > 0 && bytes <= text.size() - at && ::wcwidth(c) >= 0;
    if (bytes == 0 || bytes > text.size() - at) {
      bytes = 1;
      state = {};
    }
    const std::size_t width = is_text ? static_cast<std::size_t>(::wcwidth(c)) : 1;
    if (taken + width > columns) break;
    cut += is_text ? text.substr(at, bytes) : "?";
    taken += width;
    at += bytes;
  }
  return cut;
}

std::string progress_in_words(const ProgressState& s, std::size_t columns) {
  const std::string number = s.number > 0 ? fmt::format("{}/{}", s.number, s.pieces) : "";
  std::string times = clock_words(s.elapsed);
  if (s.left) times += fmt::format(", about {} left", clock_words(*s.left));
  const std::string what = in_columns(s.what, columns);
  std::string head = s.program + (number.empty() ? "" : " " + number);
  const auto room = [&] {
    const std::size_t taken = head.size() + times.size() + (head.empty() ? 2 : 4);
    return columns > taken ? columns - taken : 0;
  };
  if (room() < std::min(columns_of(what), least_of_what)) head = number;
  const std::string said = in_columns(what, room());
  std::string line = head;
  for (const std::string& part : {said, times}) {
    if (!part.empty()) line += (line.empty() ? "" : between) + part;
  }
  return in_columns(line, columns);
}

}  // namespace qddot::inline kit
