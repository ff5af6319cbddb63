#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/study.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/integrators/set_of.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/scene/scene.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace qddot::inline kit {

// Exit statuses of the programs.
enum ExitStatus { done = 0, failed = 1, bad_input = 2, end_not_reached = 3 };

// The text in one line without control characters.
std::string in_one_line(const std::string& text);

// The word as a shell reads it back: quoted if necessary.
std::string shell_word(const std::string& word);

// Writes a line to stderr, after removing the line of the progress. Does not throw if stderr cannot
// be written (fmt::print does, on a full disk).
void say(const std::string& line);

class Program;

// The value of an option that a Program declares: its default until the program runs, then the
// user's. A copy is of the same option.
template <class T>
class Argument {
 public:
  Argument(Program& program, std::string name, T& value)
      : program_(&program), name_(std::move(name)), value_(&value) {}

  const T& operator*() const { return *value_; }
  const T* operator->() const { return value_; }
  operator const T&() const { return *value_; }
  const std::string& name() const { return name_; }
  bool is_given() const;

  // Lets the last value count if the option is given more than once, which is refused otherwise.
  Argument& last();
  // Calls allow(value, name of the option) before the program's work, if the option is given. It
  // may throw InvalidInput.
  template <class Check>
  Argument& check(Check allow);
  // The same for each entry of a list.
  template <class Check>
  Argument& check_each(Check allow) {
    return check([allow](const T& values, const std::string& name) {
      for (const auto& value : values) allow(value, name);
    });
  }
  // Refuses all but finite numbers above zero; `meaning` says what the number is.
  Argument& positive(const std::string& meaning);
  // Refuses all but whole numbers from `low` to `high`.
  Argument& within(int low, int high);

 private:
  friend class Program;
  Program* program_;
  std::string name_;
  T* value_;
};

// A table X.csv in the folder of a program (--out), with its sidecar X.json. It can be written
// while Program::study or Program::write works.
class Table {
 public:
  Table(std::string file, std::vector<std::string> header)
      : file_(std::move(file)), header_(std::move(header)) {}
  virtual ~Table() = default;  // a Program owns tables of all rows
  CsvFile& operator*() { return *csv_; }
  CsvFile* operator->() { return csv_.get(); }
  // Adds entries to the sidecar of this table alone.
  void note(const nlohmann::json& notes) { notes_.update(notes); }

 private:
  friend class Program;
  nlohmann::json with_notes(nlohmann::json origin) const {
    origin.update(notes_);
    return origin;
  }

  std::string file_;
  std::vector<std::string> header_;
  std::unique_ptr<CsvFile> csv_;
  nlohmann::json notes_ = nlohmann::json::object();
};

// The same with columns, each made from a Row.
template <class Row>
class RowTable : public Table {
 public:
  RowTable(std::string file, Columns<Row> columns)
      : Table(std::move(file), columns.header()), columns_(std::move(columns)) {}
  void add(const Row& row) { columns_.write_row(**this, row); }
  const Columns<Row>& columns() const { return columns_; }

 private:
  Columns<Row> columns_;
};

// Groups of options that a program may have.
enum OptionGroup {
  has_threads,  // --threads: cores of one run; results do not depend on it
  has_resume,   // --resume, see Study
  has_shares    // --list-shares, --share, --journal and --kept, see Study
};

// A program: its options, its tables and its work. In main(), declare the options and tables, and
// return run(). Every program takes --force, --time-limit, --progress and --version.
class Program {
 public:
  // `summary` is for --help.
  Program(std::string name, const std::string& summary, SetOf<OptionGroup> groups = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  using Text = const std::string&;
  // Options, with their texts in --help. A default that is given is shown there. A name without
  // dashes is a positional argument. Lists are written a,b,...
  Argument<double> number(Text name, Text text) { return declare(name, 0., text, false); }
  Argument<double> number(Text name, double value, Text text) {
    return declare(name, value, text, true);
  }
  Argument<int> whole(Text name, Text text) { return declare(name, 0, text, false); }
  Argument<int> whole(Text name, int value, Text text) { return declare(name, value, text, true); }
  Argument<std::string> word(Text name, Text text) {
    return declare(name, std::string(), text, false);
  }
  Argument<std::string> word(Text name, Text value, Text text) {
    return declare(name, value, text, true);
  }
  Argument<std::vector<double>> numbers(Text name, Text text) {
    return declare(name, std::vector<double>(), text, false);
  }
  Argument<std::vector<double>> numbers(Text name, std::vector<double> values, Text text) {
    return declare(name, std::move(values), text, true);
  }
  Argument<std::vector<int>> wholes(Text name, std::vector<int> values, Text text) {
    return declare(name, std::move(values), text, true);
  }
  Argument<std::vector<std::string>> words(Text name, Text text) {
    return declare(name, std::vector<std::string>(), text, false);
  }
  Argument<std::vector<std::string>> words(Text name, std::vector<std::string> values, Text text) {
    return declare(name, std::move(values), text, true);
  }
  // An option whose value is kept elsewhere, a double, int, bool, std::string or a vector. Lists
  // are of several words here.
  template <class T>
  Argument<T> bind(Text name, T& value, Text text, bool is_shown = false);
  // A number that may be given several times.
  Argument<std::vector<double>> repeated_number(Text name, Text text);
  Argument<bool> flag(Text name, Text text) { return declare(name, false, text, false); }

  // Options that several programs share: --scene and --no-reduce; --until; --methods; --repeats,
  // --point-limit and --clock; those of the methods (see allowed_options.hpp).
  Argument<SceneChoice> scene();
  Argument<SceneChoice> drawn_scene();  // --scene alone
  Argument<double> until(Text text = "the time to run to in s (default: the scene's own)") {
    return number("--until", text);
  }
  Argument<std::vector<std::string>> methods(Text text = "a,b,...: the methods (default: all)") {
    return words("--methods", text);
  }
  // --steps, step sizes [s].
  Argument<std::vector<double>> steps(std::vector<double> usual);
  Argument<Effort> effort(const Effort& usual = {});
  Argument<Options> method_options(const Options& usual = {});

  // --out, the folder for the tables, which must be given. Tables declare it if this does not.
  void out(const std::string& text, const std::string& meaning = "the folder for the results");
  const std::string& folder() const { return folder_; }
  // A table with this header, or with these columns.
  Table& table(const std::string& file, const std::vector<std::string>& header);
  template <class Row>
  RowTable<Row>& table(const std::string& file, Columns<Row> columns);
  // Another file in the folder, which appears together with the tables; see WholeFile for
  // `beginning`. Null until they can be written.
  std::unique_ptr<WholeFile>& file(const std::string& name, const std::string& beginning);
  // An option that takes a word and asks for other work, without --out. No option but --force and
  // --progress may be given beside it.
  Argument<std::string> instead(Text name, Text text) {
    instead_ = name;
    return word(name, text);
  }

  // Parses the command line, checks the values and runs `work`. SIGINT, SIGTERM and the time limit
  // interrupt it (see interruptible.hpp). Returns the exit status: that of `work`, or after one
  // sentence, "program: ...", on stderr:
  // - bad_input for a wrong option or an InvalidInput,
  // - end_not_reached if a result cannot be written (CannotWrite) or there is no reference,
  // - 130 for a signal,
  // - failed for any other exception.
  int run(int argc, char** argv, const std::function<int()>& work);

  // Only reads the options and checks their values, as run() does. Throws InvalidInput.
  void parse(int argc, const char* const* argv);

  // Runs a study with these tables, which may be interrupted and divided (see Study):
  // measure(study) makes its pieces. Then report() or report(study) fills the tables, unless one
  // share is measured, and returns how they were made. `about`: all that decides the results beside
  // options and code. Returns the exit status.
  template <class Report>
  int study(const nlohmann::json& about, const Shares& shares,
            const std::function<void(Study&)>& measure, const Report& report) {
    return run_study(about, shares, measure, [&](Study& study) {
      if constexpr (std::invocable<Report, Study&>) {
        return report(study);
      } else {
        return report();
      }
    });
  }
  template <class Report>
  int study(const nlohmann::json& about, const std::function<void(Study&)>& measure,
            const Report& report) {
    return study(about, {}, measure, report);
  }
  // The simplest study: a table with the row make(method, value) for each method and value of its
  // knob. Each row is a piece, and each method a share where the program has shares.
  template <class Row, class Make>
  int each(const Subject& subject, const std::vector<const Method*>& methods,
           const std::vector<double>& values, RowTable<Row>& table, const Make& make);
  // Opens the tables, calls fill(), which returns how they were made, and gives them their names.
  int write(const std::function<nlohmann::json()>& fill);

  // The record of how a result is made (see provenance.hpp), with the end time of the subject.
  nlohmann::json origin() const;
  nlohmann::json origin(const Subject& subject) const;

  // The command line as given.
  const std::vector<std::string>& command_line() const { return command_line_; }
  const std::string& name() const { return name_; }
  bool has(const std::string& option) const;
  // The options that were given with their values, in the order of declaration; their names,
  // repeated and in the order in which they were given.
  std::vector<std::pair<std::string, std::vector<std::string>>> given() const;
  std::vector<std::string> order() const;

 private:
  template <class T>
  friend class Argument;

  int run_study(const nlohmann::json& about, const Shares& shares,
                const std::function<void(Study&)>& measure,
                const std::function<nlohmann::json(Study&)>& report);
  template <class T>
  T& keep(T value) {
    const auto kept = std::make_shared<T>(std::move(value));
    values_.push_back(kept);
    return *kept;
  }
  template <class T>
  Argument<T> declare(Text name, T value, Text text, bool is_shown);
  CLI::Option* option(const std::string& name) const;
  void let_last_count(const std::string& name);
  void declare_threads();
  void declare_shares();
  StudyCall study_call() const;
  void require_alone(const std::string& option) const;
  int complain(const std::string& sentence, int status) const;
  void open_tables();

  std::string name_;
  SetOf<OptionGroup> groups_;
  std::unique_ptr<CLI::App> app_;  // hidden, since its headers take six seconds to compile
  std::vector<std::shared_ptr<void>> values_;
  std::vector<std::function<void()>> checks_;
  std::vector<std::unique_ptr<Table>> tables_;
  struct File {
    std::string name, beginning;
    std::unique_ptr<WholeFile> file{};
  };
  std::vector<std::unique_ptr<File>> files_;
  std::string folder_, meaning_of_folder_, instead_;
  std::vector<std::string> command_line_;
};

// Creates the folder and its parents; throws InvalidInput if that cannot be done.
void require_folder(const std::string& folder);

// The scene that was chosen, until the time asked for with --until or the scene's own. Throws
// InvalidInput.
Subject subject_of(const SceneChoice& choice, const Argument<double>& until);

template <class T>
bool Argument<T>::is_given() const {
  return program_->has(name_);
}

template <class T>
Argument<T>& Argument<T>::last() {
  program_->let_last_count(name_);
  return *this;
}

template <class T>
template <class Check>
Argument<T>& Argument<T>::check(Check allow) {
  program_->checks_.emplace_back([argument = *this, allow] {
    if (argument.is_given()) allow(*argument, argument.name_);
  });
  return *this;
}

template <class T>
Argument<T>& Argument<T>::positive(const std::string& meaning) {
  return check(
      [meaning](double value, const std::string& name) { require_positive(value, name, meaning); });
}

template <class T>
Argument<T>& Argument<T>::within(int low, int high) {
  return check([=](int value, const std::string& name) { require_within(value, low, high, name); });
}

template <class Row>
RowTable<Row>& Program::table(const std::string& file, Columns<Row> columns) {
  auto table = std::make_unique<RowTable<Row>>(file, std::move(columns));
  RowTable<Row>& made = *table;
  tables_.push_back(std::move(table));
  return made;
}

template <class Row, class Make>
int Program::each(const Subject& subject, const std::vector<const Method*>& methods,
                  const std::vector<double>& values, RowTable<Row>& table, const Make& make) {
  const auto measure = [&](Study& study) {
    const auto taken = study.taken(methods);
    progress().begin(taken.size() * values.size());
    for (const Method* method : taken) {
      for (const double value : values) {
        const std::string name = fmt::format("{} {:.17g}", method->name, value);
        progress().now_at(name);
        const nlohmann::json row = study.piece(name, [&] {
          Csv csv;
          table.columns().write_row(csv, make(*method, value));
          return nlohmann::json(csv.text());
        });
        table->rows(row.get<std::string>());
        progress().finish(name);
      }
    }
  };
  return study(subject.about(), {.names = names_of(methods), .chosen_by = {"--methods"}}, measure,
               [&] {
                 fmt::print("{} has a row for each run\n", table->path());
                 return origin(subject);
               });
}

}  // namespace qddot::inline kit
