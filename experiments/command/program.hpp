#pragma once

#include <functional>
#include <string>

#include "experiments/command/command_line.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::command {

// What an experiment's process tells its caller.
enum ExitStatus { done = 0, failed = 1, bad_input = 2, end_not_reached = 3 };

// The text in one line without control characters, whatever names it holds.
std::string in_one_line(const std::string& text);

// Writes a line to stderr, where that takes it: unlike fmt::print it does not throw where a full
// disk takes no more. Takes the line of the progress away first.
void say(const std::string& line);

// Parses the command line into what `line` binds, and --force, --time-limit, --progress and
// --version, and runs `body`, which SIGINT, SIGTERM and the time limit interrupt (see
// interruptible.hpp). --help prints and returns 0. Prints one sentence, "program: ...", and returns
// bad_input for a wrong option or an InvalidInput, end_not_reached for what cannot be written
// (CannotWrite) or has no reference, 130 for a signal, and failed for any other exception.
int run_program(CommandLine& line, int argc, char** argv, const std::function<int()>& body);

// Adds --threads: the cores that forces, stiffness and factorisations of one run may use, 1 unless
// more are asked for, so that times of methods compare. Results do not depend on it.
void add_threads_option(CommandLine& line);

// Throws InvalidInput unless `value` is finite and greater than zero.
void require_positive(double value, const std::string& option, const std::string& meaning);

// Throws InvalidInput unless `value` is from `low` to `high`.
void require_within(int value, int low, int high, const std::string& option);

// Throws InvalidInput unless that many timed runs of a point (--repeats) are 1 to 1000.
void require_repeats(int repeats);

// Throws InvalidInput, naming what is missing, if `text` is empty.
void require_given(const std::string& text, const std::string& option, const std::string& meaning);

// The end time [s]: what the user asked for, else the scene's own. Throws InvalidInput if there is
// neither or it is not positive.
double end_time(double asked, bool is_asked, const Scene& scene);

// Creates the folder and its parents; throws InvalidInput if that cannot be done.
void require_folder(const std::string& folder);

}  // namespace qddot::command
