#pragma once

#include <functional>
#include <string>

#include "experiments/kit/command_line.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::inline kit {

// Exit statuses of the programs.
enum ExitStatus { done = 0, failed = 1, bad_input = 2, end_not_reached = 3 };

// The text in one line without control characters.
std::string in_one_line(const std::string& text);

// Writes a line to stderr, after removing the line of the progress. Does not throw if stderr cannot
// be written (fmt::print does, on a full disk).
void say(const std::string& line);

// Parses the command line, with --force, --time-limit, --progress and --version besides the options
// of `line`, and runs `body`. SIGINT, SIGTERM and the time limit interrupt it (see
// interruptible.hpp). Returns the exit status: that of `body`, or after one sentence, "program:
// ...", on stderr:
// - bad_input for a wrong option or an InvalidInput,
// - end_not_reached if a result cannot be written (CannotWrite) or there is no reference,
// - 130 for a signal,
// - failed for any other exception.
int run_program(CommandLine& line, int argc, char** argv, const std::function<int()>& body);

// Adds --threads: the number of cores that forces, stiffness and factorisations of one run may use.
// The default is 1, so that times of methods compare. Results do not depend on it.
void add_threads_option(CommandLine& line);

// Throws InvalidInput unless `value` is finite and greater than zero.
void require_positive(double value, const std::string& option, const std::string& meaning);

// Throws InvalidInput unless `value` is from `low` to `high`.
void require_within(int value, int low, int high, const std::string& option);

// Throws InvalidInput unless --repeats, the number of timed runs of a point, is 1 to 1000.
void require_repeats(int repeats);

// Throws InvalidInput, naming what is missing, if `text` is empty.
void require_given(const std::string& text, const std::string& option, const std::string& meaning);

// The end time [s]: the one the user asked for, else the scene's own. Throws InvalidInput if there
// is neither or it is not positive.
double end_time(double asked, bool is_asked, const Scene& scene);

// Creates the folder and its parents; throws InvalidInput if that cannot be done.
void require_folder(const std::string& folder);

}  // namespace qddot::inline kit
