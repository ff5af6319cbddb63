#include "experiments/kit/progress.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cwchar>
#include <locale.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {
namespace {

constexpr double between_redraws = 0.1;  // [s]
constexpr std::size_t usual_columns = 80, no_limit = 1000;
// A terminal may show ^C behind the line, and terminals differ in what they clear past the last
// column.
constexpr std::size_t kept_free = 3;

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::size_t columns_of_stderr() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return usual_columns;
  return size.ws_col;
}

// Text that cannot be written is lost: no result depends on it.
void write_to_stderr(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

bool is_terminal() {
  const char* term = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) && term && *term && std::string_view(term) != "dumb";
}

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
  const auto room_left = [&] {
    const std::size_t taken = head.size() + times.size() + (head.empty() ? 2 : 4);
    return columns > taken ? columns - taken : 0;
  };
  if (room_left() < std::min(columns_of(what), least_of_what)) head = number;
  const std::string said = in_columns(what, room_left());
  std::string line = head;
  for (const std::string& part : {said, times}) {
    if (!part.empty()) line += (line.empty() ? "" : between) + part;
  }
  return in_columns(line, columns);
}

Progress::Screen Progress::standard_error() {
  return {steady_seconds, columns_of_stderr, write_to_stderr};
}

void Progress::start(const std::string& program, Form form, double quiet) {
  const std::lock_guard lock(mutex_);
  form_ = form;
  state_ = {.program = program};
  done_ = 0;
  begun_ = last_finish_ = screen_.now();
  next_plain_ = begun_ + quiet;
}

void Progress::stage(const std::string& what) {
  const std::lock_guard lock(mutex_);
  state_.number = 0;
  state_.what = what;
  show();
}

void Progress::begin(std::size_t pieces) {
  const std::lock_guard lock(mutex_);
  state_.pieces = pieces;
  state_.number = done_ = 0;
  over_by_.reset();
  last_finish_ = screen_.now();
  measured_ = 0;
  measured_pieces_ = 0;
}

void Progress::now_at(const std::string& what) {
  const std::lock_guard lock(mutex_);
  state_.number = std::min(done_ + 1, state_.pieces);
  state_.what = what;
  show();
}

void Progress::finish(const std::string& what) {
  const std::lock_guard lock(mutex_);
  const double now = screen_.now();
  if (now - last_finish_ >= kept) {
    measured_ += now - last_finish_;
    ++measured_pieces_;
  }
  last_finish_ = now;
  state_.number = done_ = std::min(done_ + 1, state_.pieces);
  if (measured_pieces_ > 0) {
    over_by_ = now + measured_ / static_cast<double>(measured_pieces_) *
                         static_cast<double>(state_.pieces - done_);
  }
  state_.what = what;
  show();
  say();
}

void Progress::left_about(double seconds) {
  const std::lock_guard lock(mutex_);
  over_by_ = screen_.now() + seconds;
}

void Progress::wipe() {
  const std::lock_guard lock(mutex_);
  clear();
}

void Progress::close() {
  const std::lock_guard lock(mutex_);
  clear();
  form_ = Form::none;
}

Progress::Form Progress::form() const {
  const std::lock_guard lock(mutex_);
  return form_;
}

void Progress::estimate(double now) {
  state_.elapsed = now - begun_;
  state_.left = over_by_ > now ? std::optional(*over_by_ - now) : std::nullopt;
}

void Progress::show() {
  const double now = screen_.now();
  if (form_ != Form::line || now - last_line_ < between_redraws) return;
  last_line_ = now;
  estimate(now);
  const std::size_t columns = screen_.columns();
  screen_.write(fmt::format(
      "\r{}\033[K", progress_in_words(state_, columns > kept_free ? columns - kept_free : 1)));
  is_visible_ = true;
}

void Progress::say() {
  const double now = screen_.now();
  if (form_ != Form::plain || now < next_plain_) return;
  next_plain_ = now + plain_pause;
  estimate(now);
  screen_.write(progress_in_words(state_, no_limit) + "\n");
}

void Progress::clear() {
  if (is_visible_) screen_.write("\r\033[K");
  is_visible_ = false;
}

Progress& progress() {
  static Progress all;
  return all;
}

void start_progress(const std::string& program, const std::string& form) {
  if (form == "none") return progress().start(program, Progress::Form::none);
  if (form == "plain") return progress().start(program, Progress::Form::plain);
  if (form != "auto") {
    throw InvalidInput(
        fmt::format("--progress {} is not allowed; it is one of auto, plain, none", form));
  }
  if (is_terminal()) return progress().start(program, Progress::Form::line);
  progress().start(program, Progress::Form::plain, Progress::plain_pause);
}

}  // namespace qddot::inline kit
