#include "experiments/kit/program.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <omp.h>
#include <string_view>
#include <system_error>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include "experiments/kit/interruptible.hpp"
#include "experiments/kit/memory.hpp"
#include "experiments/kit/provenance.hpp"
#include "qddot/integrators/nearest_name.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/model/kernels/level.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {
namespace {

using Numbers = std::vector<double>;
using Words = std::vector<std::string>;

// Calls parse(), and says what is wrong in the words of an InvalidInput.
template <class Parse>
void in_one_sentence(const Parse& parse) {
  try {
    parse();
  } catch (const CLI::Success&) {
    throw;
  } catch (const CLI::ConversionError& error) {
    throw InvalidInput(fmt::format("{}; allowed is a number", error.what()));
  } catch (const CLI::ParseError& error) {
    throw InvalidInput(error.what());
  }
}

// The option that was meant by an unknown one: another program's word for the step size, or a
// misspelt name. Empty if there is none.
std::string meant_option(const std::string& given, const CLI::App& app) {
  constexpr std::array step_size = {"--h", "--dt", "-dt", "--timestep", "--time-step"};
  Words names;
  for (const CLI::Option* option : app.get_options()) names.push_back(option->get_name());
  const bool is_step = std::ranges::find(step_size, given) != step_size.end();
  if (is_step && std::ranges::find(names, "--step-size") != names.end()) return "--step-size";
  return nearest_name(given, names);
}

template <class... Kinds>
bool is_any_of(const std::exception& error) {
  return (dynamic_cast<const Kinds*>(&error) || ...);
}

int status_of(const std::exception& error) {
  if (is_any_of<InvalidInput, kernels::NoSuchKernels>(error)) return bad_input;
  // The scene does not have the quantity that is asked for, or its numbers overflow on the way.
  if (is_any_of<CannotWrite, NoReference, std::domain_error, std::range_error>(error))
    return end_not_reached;
  return failed;
}

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

std::string shell_word(const std::string& word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!word.empty() && word.find_first_not_of(plain) == word.npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

Program::Program(std::string name, const std::string& summary, SetOf<OptionGroup> groups)
    : name_(std::move(name)), groups_(groups), app_(std::make_unique<CLI::App>(summary, name_)) {}

Program::~Program() = default;

template <class T>
Argument<T> Program::declare(Text name, T value, Text text, bool is_shown) {
  Argument<T> argument = bind(name, keep(std::move(value)), text, is_shown);
  if constexpr (requires { typename T::value_type; } && !std::same_as<T, std::string>)
    option(name)->delimiter(',');
  return argument;
}
template Argument<bool> Program::declare(Text, bool, Text, bool);
template Argument<double> Program::declare(Text, double, Text, bool);
template Argument<int> Program::declare(Text, int, Text, bool);
template Argument<std::string> Program::declare(Text, std::string, Text, bool);
template Argument<Numbers> Program::declare(Text, Numbers, Text, bool);
template Argument<std::vector<int>> Program::declare(Text, std::vector<int>, Text, bool);
template Argument<Words> Program::declare(Text, Words, Text, bool);

template <class T>
Argument<T> Program::bind(Text name, T& value, Text text, bool is_shown) {
  if constexpr (std::same_as<T, bool>) {
    app_->add_flag(name, value, text);
  } else {
    CLI::Option* option = app_->add_option(name, value, text);
    if (is_shown) option->capture_default_str();
  }
  return {*this, name, value};
}
template Argument<bool> Program::bind(Text, bool&, Text, bool);
template Argument<double> Program::bind(Text, double&, Text, bool);
template Argument<int> Program::bind(Text, int&, Text, bool);
template Argument<std::string> Program::bind(Text, std::string&, Text, bool);
template Argument<Numbers> Program::bind(Text, Numbers&, Text, bool);
template Argument<Words> Program::bind(Text, Words&, Text, bool);

Argument<Numbers> Program::repeated_number(Text name, Text text) {
  Argument<Numbers> argument = bind(name, keep(Numbers()), text);
  option(name)->expected(1)->take_all();
  return argument;
}

Argument<SceneChoice> Program::scene() {
  const Argument<SceneChoice> scene = drawn_scene();
  bind("--no-reduce", scene.value_->no_reduce,
       fmt::format("a,b,...: reductions of the scene to leave out (default: none), of {}",
                   fmt::join(reduction_names, ", ")));
  option("--no-reduce")->delimiter(',');
  return scene;
}

Argument<SceneChoice> Program::drawn_scene() {
  SceneChoice& choice = keep(SceneChoice());
  bind("--scene", choice.name, "a generator's name or a scene file");
  return {*this, "--scene", choice};
}

Argument<std::vector<double>> Program::steps(std::vector<double> usual) {
  return numbers("--steps", std::move(usual), "a,b,...: the step sizes in s")
      .check_each([](double h, const std::string& name) { require_step_size(h, name); });
}

Argument<Effort> Program::effort(const Effort& usual) {
  Effort& effort = keep(usual);
  bind("--repeats", effort.repeats, "timed runs of each point", true).last().within(1, 1000);
  bind("--point-limit", effort.seconds,
       "seconds that one run of a point may take; slower ones become over_budget", true)
      .last()
      .positive("the seconds a run may take");
  word("--clock", "wall",
       "the clock of times: wall, or processor, which stands still while other programs run")
      .check([](const std::string& clock, const std::string& option) {
        if (clock != "wall" && clock != "processor") {
          throw InvalidInput(
              fmt::format("{} {} is not allowed; it is wall or processor", option, clock));
        }
        clock_in_use = clock == "wall" ? std::chrono::steady_clock::now : processor_time;
      });
  return {*this, "--repeats", effort};
}

void Program::out(const std::string& text, const std::string& meaning) {
  meaning_of_folder_ = meaning;
  bind("--out", folder_, text);
}

Table& Program::table(const std::string& file, const std::vector<std::string>& header) {
  tables_.push_back(std::make_unique<Table>(file, header));
  return *tables_.back();
}

std::unique_ptr<WholeFile>& Program::file(const std::string& name, const std::string& beginning) {
  files_.push_back(std::make_unique<File>(File{name, beginning}));
  return files_.back()->file;
}

void Program::declare_threads() {
  omp_set_num_threads(1);
  whole("--threads", "number of cores that a run of a large scene may use (default: 1)")
      .last()
      .check([](int threads, const std::string& name) {
        require_within(threads, 1, 256, name);
        omp_set_num_threads(threads);
      });
}

void Program::declare_shares() {
  flag("--list-shares",
       "print, as JSON, the shares of the study that processes can measure independently, and its "
       "key");
  word("--share", "measure this share alone, into the file --journal").last();
  word("--journal", "the file for the results of --share").last();
  flag("--kept",
       "measure nothing: make the tables from the complete shares in the folder's journal");
}

int Program::run(int argc, char** argv, const std::function<int()>& work) {
  if (meaning_of_folder_.empty() && !tables_.empty()) {
    std::string files;
    for (const auto& table : tables_) files += (files.empty() ? "" : ", ") + table->file_;
    out("the folder for " + files);
  }
  if (groups_.has(has_threads)) declare_threads();
  if (groups_.has(has_resume)) {
    flag("--resume",
         "go on with an interrupted run of the same command: measure only what is missing");
  }
  if (groups_.has(has_shares)) declare_shares();
  app_->set_version_flag("--version", fmt::format("{} of qddot {}, {}", name_, build_info::version,
                                                  build_info::compiler));
  const auto force = flag("--force", "replace files that qddot did not write");
  const auto limit = number("--time-limit",
                            "seconds after which the program ends in order and keeps its results "
                            "so far (default: none)")
                         .last();
  const auto form =
      word("--progress", "auto", "how progress is shown on stderr, one of auto, plain, none")
          .last();
  command_line_.assign(argv, argv + argc);
  keep_freed_memory();
  try {
    Interruptible run(name_);
    try {
      parse(argc, argv);
    } catch (const CLI::Success& help) {
      return app_->exit(help);
    }
    if (force) allow_replacing();
    start_progress(name_, form);
    if (limit.is_given()) {
      require_positive(limit, "--time-limit", "the seconds that the program may take");
      run.end_after(limit);
    }
    if (!instead_.empty() && has(instead_)) {
      require_alone(instead_);
    } else if (!meaning_of_folder_.empty()) {
      require_given(folder_, "--out", meaning_of_folder_);
    }
    const int status = work();
    progress().wipe();
    return status;
  } catch (const Interrupted& error) {
    return complain(error.what(), error.status);
  } catch (const std::exception& error) {
    if (is_any_of<std::bad_alloc, std::system_error>(error))  // no thread can be started
      return complain(out_of_memory(), end_not_reached);
    return complain(error.what(), status_of(error));
  }
}

void Program::parse(int argc, const char* const* argv) {
  try {
    in_one_sentence([&] { app_->parse(argc, argv); });
  } catch (const InvalidInput&) {
    const Words unknown = app_->remaining();
    const auto first = std::ranges::find_if(
        unknown, [](const std::string& word) { return word.starts_with("-"); });
    if (first == unknown.end()) throw;
    const std::string option = first->substr(0, first->find('='));
    const std::string meant = meant_option(option, *app_);
    throw InvalidInput(fmt::format("{} is not an option of {}{}; --help lists them all", option,
                                   name_, meant.empty() ? "" : ", the nearest is " + meant));
  }
  for (const auto& check : checks_) check();
}

void Program::require_alone(const std::string& option) const {
  for (const auto& [other, values] : given()) {
    if (other == option || other == "--force" || other == "--progress") continue;
    throw InvalidInput(
        fmt::format("{} is not allowed with {}, which measures nothing", other, option));
  }
}

int Program::complain(const std::string& sentence, int status) const {
  say(fmt::format("{}: {}", name_, in_one_line(sentence)));
  return status;
}

CLI::Option* Program::option(const std::string& name) const { return app_->get_option(name); }

void Program::let_last_count(const std::string& name) { option(name)->take_last(); }

bool Program::has(const std::string& option) const {
  const CLI::Option* known = app_->get_option_no_throw(option);
  return known && known->count() > 0;
}

std::vector<std::pair<std::string, std::vector<std::string>>> Program::given() const {
  std::vector<std::pair<std::string, std::vector<std::string>>> all;
  for (const CLI::Option* option : std::as_const(*app_).get_options()) {
    if (option->count() > 0) all.emplace_back(option->get_name(), option->results());
  }
  return all;
}

std::vector<std::string> Program::order() const {
  std::vector<std::string> names;
  for (const CLI::Option* option : app_->parse_order()) names.push_back(option->get_name());
  return names;
}

void Program::open_tables() {
  require_folder(folder_);
  for (const auto& table : tables_)
    table->csv_ = std::make_unique<CsvFile>(folder_ + "/" + table->file_, table->header_);
  for (const auto& file : files_)
    file->file = std::make_unique<WholeFile>(folder_ + "/" + file->name, file->beginning);
}

int Program::run_study(const nlohmann::json& about, const Shares& shares,
                       const std::function<void(Study&)>& measure,
                       const std::function<nlohmann::json(Study&)>& report) {
  std::vector<std::string> files;
  for (const auto& table : tables_) files.push_back(table->file_);
  Study study(study_call(), folder_, files, about, shares);
  if (const auto status = study.completed()) return *status;
  open_tables();
  study.measure([&] { measure(study); });
  if (study.is_share()) return study.conclude(study.falls_short() ? end_not_reached : done);
  const nlohmann::json origin = report(study);
  const int status = study.falls_short() ? end_not_reached : done;
  for (const auto& table : tables_) study.complete(**table, table->with_notes(origin), status);
  for (const auto& file : files_) study.complete(*file->file);
  return study.conclude(status);
}

int Program::write(const std::function<nlohmann::json()>& fill) {
  open_tables();
  const nlohmann::json origin = fill();
  for (const auto& table : tables_) (*table)->commit(table->with_notes(origin));
  return done;
}

StudyCall Program::study_call() const {
  // These options say where results go and how the program runs; they decide no result.
  constexpr std::array other = {"--out",         "--scene",    "--resume",  "--force",
                                "--time-limit",  "--progress", "--help",    "--version",
                                "--list-shares", "--share",    "--journal", "--kept"};
  StudyCall call{.program = name_,
                 .resumes = has("--resume"),
                 .lists_shares = has("--list-shares"),
                 .is_of_kept = has("--kept")};
  for (const auto& [name, values] : given()) {
    if (name == "--share") call.share = values.back();
    if (name == "--journal") call.journal = values.back();
    if (std::ranges::find(other, name) == other.end()) call.options[name] = values;
  }
  return call;
}

nlohmann::json Program::origin() const { return provenance(command_line_); }

nlohmann::json Program::origin(const Subject& subject) const {
  auto json = provenance(command_line_, subject.drawn, subject.start(), subject.model);
  if (subject.until > 0) json["until"] = subject.until;
  return json;
}

Subject subject_of(const SceneChoice& choice, const Argument<double>& until) {
  Scene drawn = load(choice);
  const double end = end_time(until, until.is_given(), drawn);
  return subject_of(std::move(drawn), choice, end);
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
