#include "experiments/kit/program.hpp"

#include <cstdio>
#include <filesystem>
#include <omp.h>
#include <system_error>

#include <fmt/format.h>

#include "experiments/kit/build_info.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/interruptible.hpp"
#include "experiments/kit/memory.hpp"
#include "experiments/kit/method_options.hpp"
#include "experiments/kit/overwriting.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
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

Program::Program(const About& about) : about_(about), line_(about.summary, about.name) {}

template <class T>
T& Program::keep(T value) {
  auto kept = std::make_shared<T>(std::move(value));
  T& place = *kept;
  values_.push_back(std::move(kept));
  return place;
}

template <class T>
Argument<T> Program::declare(const std::string& name, T value, const std::string& text,
                             bool is_shown) {
  T& place = keep(std::move(value));
  auto taken = line_.add_option(name, place, text);
  if constexpr (requires { typename T::value_type; } && !std::same_as<T, std::string>)
    taken.delimiter(',');
  if (is_shown) taken.capture_default_str();
  return {*this, name, place, {taken}};
}

Argument<double> Program::number(const std::string& name, const std::string& text) {
  return declare(name, 0., text, false);
}
Argument<double> Program::number(const std::string& name, double value, const std::string& text) {
  return declare(name, value, text, true);
}
Argument<int> Program::whole(const std::string& name, const std::string& text) {
  return declare(name, 0, text, false);
}
Argument<int> Program::whole(const std::string& name, int value, const std::string& text) {
  return declare(name, value, text, true);
}
Argument<std::string> Program::word(const std::string& name, const std::string& text) {
  return declare(name, std::string(), text, false);
}
Argument<std::string> Program::word(const std::string& name, const std::string& value,
                                    const std::string& text) {
  return declare(name, value, text, true);
}
Argument<std::vector<double>> Program::numbers(const std::string& name, const std::string& text) {
  return declare(name, std::vector<double>(), text, false);
}
Argument<std::vector<double>> Program::numbers(const std::string& name, std::vector<double> values,
                                               const std::string& text) {
  return declare(name, std::move(values), text, true);
}
Argument<std::vector<int>> Program::wholes(const std::string& name, std::vector<int> values,
                                           const std::string& text) {
  return declare(name, std::move(values), text, true);
}
Argument<std::vector<std::string>> Program::words(const std::string& name,
                                                  const std::string& text) {
  return declare(name, std::vector<std::string>(), text, false);
}
Argument<std::vector<std::string>> Program::words(const std::string& name,
                                                  std::vector<std::string> values,
                                                  const std::string& text) {
  return declare(name, std::move(values), text, true);
}
Argument<bool> Program::flag(const std::string& name, const std::string& text) {
  bool& place = keep(false);
  line_.add_flag(name, place, text);
  return {*this, name, place, {}};
}

Argument<SceneChoice> Program::scene() {
  SceneChoice& choice = keep(SceneChoice());
  add_scene_options(line_, choice);
  return {*this, "--scene", choice, {}};
}

Argument<double> Program::until(const std::string& text) { return number("--until", text); }

Argument<std::vector<std::string>> Program::methods(const std::string& text) {
  return words("--methods", text);
}

Argument<std::vector<double>> Program::steps(std::vector<double> usual) {
  return numbers("--steps", std::move(usual), "a,b,...: the step sizes in s")
      .check_each([](double h, const std::string& name) { require_step_size(h, name); });
}

Argument<Effort> Program::effort(const Effort& usual) {
  Effort& effort = keep(usual);
  Argument<int>(*this, "--repeats", effort.repeats,
                {line_.add_option("--repeats", effort.repeats, "timed runs of each point")
                     .take_last()
                     .capture_default_str()})
      .within(1, 1000);
  Argument<double>(
      *this, "--point-limit", effort.seconds,
      {line_
           .add_option("--point-limit", effort.seconds,
                       "seconds that one run of a point may take; slower ones become over_budget")
           .take_last()
           .capture_default_str()})
      .positive("the seconds a run may take");
  return {*this, "--repeats", effort, {}};
}

Argument<Options> Program::method_options(const Options& usual) {
  Options& options = keep(usual);
  add_method_options(line_, options);
  return {*this, "--max-order", options, {}};
}

void Program::out(const std::string& text, const std::string& meaning) {
  meaning_of_folder_ = meaning;
  line_.add_option("--out", folder_, text);
}

Table& Program::table(const std::string& file, const std::vector<std::string>& header) {
  tables_.push_back(std::make_unique<Table>(file, header));
  return *tables_.back();
}

int Program::run(int argc, char** argv, const std::function<int()>& work) {
  if (meaning_of_folder_.empty() && !tables_.empty()) {
    std::string files;
    for (const auto& table : tables_) files += (files.empty() ? "" : ", ") + table->file_;
    out("the folder for " + files);
  }
  if (about_.has_threads) add_threads_option(line_);
  if (about_.has_resume) add_resume_option(line_);
  if (about_.has_shares) add_share_options(line_);
  command_line_.assign(argv, argv + argc);
  return run_program(line_, argc, argv, [&] {
    if (!meaning_of_folder_.empty()) require_given(folder_, "--out", meaning_of_folder_);
    for (const auto& check : checks_) check();
    return work();
  });
}

void Program::open_tables() {
  require_folder(folder_);
  for (const auto& table : tables_)
    table->csv_ = std::make_unique<CsvFile>(folder_ + "/" + table->file_, table->header_);
}

int Program::study(const nlohmann::json& about, const Shares& shares,
                   const std::function<void(Study&)>& measure,
                   const std::function<nlohmann::json()>& report) {
  std::vector<std::string> files;
  for (const auto& table : tables_) files.push_back(table->file_);
  Study study(line_, folder_, files, about, shares);
  if (const auto status = study.completed()) return *status;
  open_tables();
  study.measure([&] { measure(study); });
  if (study.is_share()) return study.conclude(study.falls_short() ? end_not_reached : done);
  const nlohmann::json origin = report();
  const int status = study.falls_short() ? end_not_reached : done;
  for (const auto& table : tables_) {
    nlohmann::json own = origin;
    own.update(table->notes_);
    study.complete(**table, std::move(own), status);
  }
  return study.conclude(status);
}

int Program::write(const std::function<nlohmann::json()>& fill) {
  open_tables();
  const nlohmann::json origin = fill();
  for (const auto& table : tables_) {
    nlohmann::json own = origin;
    own.update(table->notes_);
    (*table)->commit(own);
  }
  return done;
}

nlohmann::json Program::origin() const { return provenance(command_line_); }

nlohmann::json Program::origin(const Subject& subject) const {
  return provenance(command_line_, subject.drawn, subject.start, subject.reduced);
}

Subject subject_of(const SceneChoice& choice, const Argument<double>& until) {
  Scene drawn = load(choice);
  const double end = end_time(until, until.is_given(), drawn);
  Scene start = started(drawn, choice);
  ReducedScene reduced(start, reductions_of(choice));
  return {choice.name, std::move(drawn), std::move(start), std::move(reduced), end};
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
