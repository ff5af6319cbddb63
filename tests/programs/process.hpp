#pragma once

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include <boost/test/unit_test.hpp>
#include <fmt/format.h>

#include "tests/folder.hpp"
#include "tests/fragments.hpp"

namespace qddot {
inline namespace tests {

inline std::string read_all(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// How a program ended; a signal counts as 128 + its number.
struct Exit {
  int status = -1;
  std::string out, err;
};

// One of the programs, running.
class Started {
 public:
  Started(const std::string& program, std::vector<std::string> arguments)
      : out_(std::tmpfile()), err_(std::tmpfile()) {
    arguments.insert(arguments.begin(), PROGRAM_FOLDER "/" + program);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    child_ = fork();
    if (child_ == 0) {
      dup2(fileno(out_), STDOUT_FILENO);
      dup2(fileno(err_), STDERR_FILENO);
      execv(argv[0], argv.data());
      _exit(127);
    }
  }

  // Waits until it has had so many seconds of the processor, however busy the machine is, or has
  // ended.
  void let_work(double seconds) const {
    clockid_t clock{};
    timespec spent{};
    siginfo_t ended{};
    const auto is_early = [&] {
      waitid(P_PID, static_cast<id_t>(child_), &ended, WEXITED | WNOHANG | WNOWAIT);
      return ended.si_pid == 0 && clock_getcpuclockid(child_, &clock) == 0 &&
             clock_gettime(clock, &spent) == 0 &&
             static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec) <
                 seconds;
    };
    while (is_early()) usleep(1000);
  }

  // Sends it a signal, if any, and waits for its end. Call it once.
  Exit end(int signal = 0) {
    int status = 0;
    if (child_ > 0 && signal != 0) kill(child_, signal);
    if (child_ < 0 || waitpid(child_, &status, 0) != child_) throw std::runtime_error("no process");
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), take(out_),
            take(err_)};
  }

 private:
  static std::string take(std::FILE* file) {
    std::string text(static_cast<std::size_t>(lseek(fileno(file), 0, SEEK_END)), '\0');
    if (pread(fileno(file), text.data(), text.size(), 0) != std::ssize(text)) text.clear();
    std::fclose(file);
    return text;
  }

  std::FILE *out_, *err_;
  pid_t child_ = -1;
};

// Runs one of the programs to its end.
inline Exit run(const std::string& program, std::vector<std::string> arguments) {
  return Started(program, std::move(arguments)).end();
}

// The words of simulate on a run, without the time that it took.
inline std::string untimed(const Exit& run) { return run.out.substr(0, run.out.rfind(", in ")); }

// Whether a program complained as it should: its status, and on stderr one line that starts with
// its name and holds the fragments.
inline bool complains(const Exit& run, int status, const std::string& program,
                      const std::vector<std::string>& fragments) {
  return run.status == status && run.err.starts_with(program + ": ") &&
         run.err.find('\n') + 1 == run.err.size() && contains(run.err, fragments);
}

inline std::string exit_in_words(const Exit& run, const std::vector<std::string>& arguments) {
  std::string text;
  for (const std::string& argument : arguments) text += argument + ' ';
  return fmt::format("{}gives {}: {}", text, run.status, run.err);
}

// Checks that a program refuses its arguments with status 2 and one line that contains the
// fragments, and leaves nothing behind. Words that start with OUT are paths in an empty folder.
inline void check_refused(const std::string& program, std::vector<std::string> words,
                          const std::vector<std::string>& fragments) {
  const Folder folder;
  for (std::string& word : words) {
    if (word.starts_with("OUT")) word = folder / word;
  }
  const Exit result = run(program, words);
  BOOST_TEST(complains(result, 2, program, fragments), exit_in_words(result, words));
  BOOST_TEST(result.out == "");
  BOOST_TEST(folder.listing() == "", exit_in_words(result, words));
}

// The number that is all of the text; throws where it is none.
inline double number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw std::runtime_error("not a number: \"" + text + "\"");
  }
  return value;
}

// A CSV file. Reading it throws unless it is RFC 4180 with as many fields in each row as in the
// header, lines ended by a line feed.
struct Table {
  std::string header;  // as it is written
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;

  std::size_t column(const std::string& name) const {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) throw std::runtime_error("no column " + name);
    return static_cast<std::size_t>(found - names.begin());
  }
  const std::string& text(std::size_t row, const std::string& name) const {
    return rows.at(row).at(column(name));
  }
  double value(std::size_t row, const std::string& name) const { return number(text(row, name)); }
};

inline Table parse_csv(const std::string& text) {
  Table table;
  std::vector<std::string> row(1);
  const auto malformed = [&] { throw std::runtime_error("not RFC 4180: " + text); };
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') {
      if (!row.back().empty()) malformed();
      for (++i; text.at(i) != '"' || (i + 1 < text.size() && text[i + 1] == '"'); ++i) {
        if (text[i] == '"') ++i;
        row.back() += text[i];
      }
      if (i + 1 == text.size() || (text[i + 1] != ',' && text[i + 1] != '\n')) malformed();
    } else if (text[i] == ',') {
      row.emplace_back();
    } else if (text[i] == '\n') {
      if (table.names.empty()) {
        table.names = row;
        table.header = text.substr(0, i);
      } else {
        table.rows.push_back(row);
      }
      if (row.size() != table.names.size()) malformed();
      row = {""};
    } else {
      row.back() += text[i];
    }
  }
  if (text.empty() || text.back() != '\n') malformed();
  return table;
}

inline Table read_csv(const std::string& path) { return parse_csv(read_all(path)); }

}  // namespace tests
}  // namespace qddot
