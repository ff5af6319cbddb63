#include "experiments/program.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <omp.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "experiments/reference.hpp"
#include "src/scene/invalid_input.hpp"

namespace qddot {
namespace {

// In one line, whatever a name in it holds.
int complain(const CLI::App& app, std::string sentence, ExitStatus status) {
  std::ranges::replace_if(
      sentence, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  fmt::print(stderr, "{}: {}\n", app.get_name(), sentence);
  return status;
}

}  // namespace

int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& body) {
  try {
    app.parse(argc, argv);
    return body();
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ConversionError& error) {
    return complain(app, fmt::format("{}; allowed is a number", error.what()), bad_input);
  } catch (const CLI::ParseError& error) {
    return complain(app, error.what(), bad_input);
  } catch (const InvalidInput& error) {
    return complain(app, error.what(), bad_input);
  } catch (const NoReference& error) {
    return complain(app, error.what(), end_not_reached);
  } catch (const std::exception& error) {
    return complain(app, error.what(), failed);
  }
}

void add_threads_option(CLI::App& app) {
  omp_set_num_threads(1);
  app.add_option_function<int>(
         "--threads",
         [](int threads) {
           require_within(threads, 1, 256, "--threads");
           omp_set_num_threads(threads);
         },
         "how many cores a run of a large scene may use (default: 1)")
      ->take_last();
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

double horizon(double asked, bool is_asked, const Scene& scene) {
  if (is_asked) {
    require_positive(asked, "--until", "the horizon in s");
    return asked;
  }
  if (!scene.until) {
    throw InvalidInput(
        fmt::format("--until is missing, and scene {} has no horizon of its own; it is the time to "
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

}  // namespace qddot
