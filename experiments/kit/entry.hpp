#pragma once

#include <string>
#include <vector>

#include "experiments/kit/command_line.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/study.hpp"

namespace qddot::inline kit {

// The name and summary of a program for --help, and the options that it shares with others.
struct Entry {
  std::string name, summary;
  bool has_threads = false, has_resume = false, has_shares = false;
};

// The main() of a program. declare(line, arguments) adds the program's own options; body(line,
// arguments, words) does the work. `words` is the command line as given (see run_program).
template <class Arguments, class Declare, class Body>
int enter(const Entry& entry, const Declare& declare, const Body& body, int argc, char** argv) {
  CommandLine line(entry.summary, entry.name);
  Arguments arguments;
  declare(line, arguments);
  if (entry.has_threads) add_threads_option(line);
  if (entry.has_resume) add_resume_option(line);
  if (entry.has_shares) add_share_options(line);
  return run_program(line, argc, argv, [&] {
    return body(line, arguments, std::vector<std::string>(argv, argv + argc));
  });
}

}  // namespace qddot::inline kit
