#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace qddot::command {

// The options that a program takes and those that it was given. CLI11 behind a pointer: every
// source that includes its headers takes six seconds longer to compile.
class CommandLine {
 public:
  // What CLI11 is to know of an option beside its name; its functions have CLI11's names.
  class Taken {
   public:
    explicit Taken(CLI::Option* option) : option_(option) {}
    Taken& take_last();            // where it is given more than once
    Taken& take_each();            // one value each time that it is given
    Taken& delimiter(char c);      // between the entries of a list
    Taken& capture_default_str();  // --help shows the value that it has now
    Taken& default_str(const std::string& text);

   private:
    CLI::Option* option_;
  };

  CommandLine(const std::string& purpose, const std::string& program);
  ~CommandLine();

  // Declares an option `--name` (or, without dashes, what stands alone), where its value goes, and
  // what --help says of it.
  Taken add_option(const std::string& name, double& value, const std::string& what);
  Taken add_option(const std::string& name, int& value, const std::string& what);
  Taken add_option(const std::string& name, std::string& value, const std::string& what);
  Taken add_option(const std::string& name, std::vector<double>& values, const std::string& what);
  Taken add_option(const std::string& name, std::vector<int>& values, const std::string& what);
  Taken add_option(const std::string& name, std::vector<std::string>& values,
                   const std::string& what);
  // The same, where `take` gets the value and may throw InvalidInput.
  Taken add_option_function(const std::string& name, const std::function<void(int)>& take,
                            const std::string& what);
  Taken add_option_function(const std::string& name,
                            const std::function<void(const std::string&)>& take,
                            const std::string& what);
  void add_flag(const std::string& name, bool& value, const std::string& what);
  void add_flag(const std::string& name, const std::string& what);
  void set_version(const std::string& version);

  // Reads what the user gave into the values. Returns the program's status where that is all it is
  // to do: --help and --version print. Throws InvalidInput.
  std::optional<int> parse(int argc, const char* const* argv);
  void parse(const std::string& options);

  std::string program() const;
  bool has(const std::string& option) const;
  // The options that were given and what each was given, as declared.
  std::vector<std::pair<std::string, std::vector<std::string>>> given() const;
  // Their names as often as, and in the order in which, they were given.
  std::vector<std::string> order() const;

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace qddot::command
