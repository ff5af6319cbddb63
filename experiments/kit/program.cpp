#include "experiments/kit/program.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <omp.h>
#include <system_error>

#include <fmt/format.h>

#include "experiments/kit/build_info.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/interruptible.hpp"
#include "experiments/kit/memory.hpp"
#include "experiments/kit/overwriting.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/measure/reference/no_reference.hpp"
#include "qddot/model/kernels/level.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {
namespace {

int complain(const CommandLine& line, const std::string& sentence, int status) {
  say(fmt::format("{}: {}", line.program(), in_one_line(sentence)));
  return status;
}

// The options that every program takes.
struct EveryProgram {
  explicit EveryProgram(CommandLine& line) {
    line.set_version(fmt::format("{} of qddot {}, {}", line.program(), build_info::version,
                                 build_info::compiler));
    line.add_flag("--force", force, "replace files that qddot did not write");
    line.add_option("--time-limit", seconds,
                    "seconds after which the program ends in order and keeps its results so far "
                    "(default: none)")
        .take_last();
    line.add_option("--progress", form, "how progress is shown on stderr, one of auto, plain, none")
        .take_last()
        .capture_default_str();
  }
  void apply(const CommandLine& line, Interruptible& run) const {
    if (force) allow_replacing();
    start_progress(line.program(), form);
    if (!line.has("--time-limit")) return;
    require_positive(seconds, "--time-limit", "the seconds that the program may take");
    run.end_after(seconds);
  }

  bool force = false;
  double seconds = 0;
  std::string form = "auto";
};

}  // namespace

std::string in_one_line(const std::string& text) {
  std::string line;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const bool begins_control =
        c == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0;
    if (c == '\n' || c == '\r' || c == '\t') {
      line += ' ';
    } else if (c < ' ' || c == 0x7f || begins_control) {
      line += '?';
      i += begins_control;
    } else {
      line += text[i];
    }
  }
  return line;
}

void say(const std::string& line) {
  progress().wipe();
  std::fputs((line + "\n").c_str(), stderr);
}

int run_program(CommandLine& line, int argc, char** argv, const std::function<int()>& body) {
  const EveryProgram options(line);
  try {
    Interruptible run(line.program());
    if (const auto status = line.parse(argc, argv)) return *status;
    options.apply(line, run);
    const int status = body();
    progress().wipe();
    return status;
  } catch (const Interrupted& error) {
    return complain(line, error.what(), error.status);
  } catch (const CannotWrite& error) {
    return complain(line, error.what(), end_not_reached);
  } catch (const InvalidInput& error) {
    return complain(line, error.what(), bad_input);
  } catch (const kernels::NoSuchKernels& error) {
    return complain(line, error.what(), bad_input);
  } catch (const NoReference& error) {
    return complain(line, error.what(), end_not_reached);
  } catch (const std::domain_error& error) {  // what is asked for does not exist for the scene
    return complain(line, error.what(), end_not_reached);
  } catch (const std::range_error& error) {  // numbers of the scene overflow on the way to it
    return complain(line, error.what(), end_not_reached);
  } catch (const std::bad_alloc&) {
    return complain(line, out_of_memory(), end_not_reached);
  } catch (const std::system_error&) {  // no thread can be started
    return complain(line, out_of_memory(), end_not_reached);
  } catch (const std::exception& error) {
    return complain(line, error.what(), failed);
  }
}

void add_threads_option(CommandLine& line) {
  omp_set_num_threads(1);
  line.add_option_function(
          "--threads",
          [](int threads) {
            require_within(threads, 1, 256, "--threads");
            omp_set_num_threads(threads);
          },
          "number of cores that a run of a large scene may use (default: 1)")
      .take_last();
}

void require_positive(double value, const std::string& option, const std::string& meaning) {
  if (std::isfinite(value) && value > 0) return;
  throw InvalidInput(fmt::format("{} {} is not allowed; it is {}, finite and greater than 0",
                                 option, value, meaning));
}

void require_within(int value, int low, int high, const std::string& option) {
  if (value >= low && value <= high) return;
  throw InvalidInput(fmt::format("{} {} is not allowed; it is a whole number from {} to {}", option,
                                 value, low, high));
}

void require_repeats(int repeats) { require_within(repeats, 1, 1000, "--repeats"); }

void require_given(const std::string& text, const std::string& option, const std::string& meaning) {
  if (text.empty()) throw InvalidInput(fmt::format("{} is missing; it is {}", option, meaning));
}

double end_time(double asked, bool is_asked, const Scene& scene) {
  if (is_asked) {
    require_positive(asked, "--until", "the time to run to in s");
    return asked;
  }
  if (!scene.until) {
    throw InvalidInput(fmt::format(
        "--until is missing, and scene {} has no end time of its own; it is the time to "
        "run to in s, greater than 0",
        scene.name));
  }
  return *scene.until;
}

void require_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw InvalidInput(
        fmt::format("--out {}: no folder can be made there ({}); allowed is a folder "
                    "that exists or whose parent can be written",
                    folder, error ? error.message() : "it is a file"));
  }
}

}  // namespace qddot::inline kit
