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

namespace qddot::inline kit {

// The options that a program takes, and their values on the command line. CLI11 is hidden behind a
// pointer, because its headers make every source compile six seconds longer.
class CommandLine {
 public:
  // Settings of an option for CLI11; its functions have CLI11's names.
  class Taken {
   public:
    explicit Taken(CLI::Option* option) : option_(option) {}
    Taken& take_last();            // if it is given more than once
    Taken& take_each();            // one value each time it is given
    Taken& delimiter(char c);      // between the entries of a list
    Taken& capture_default_str();  // --help shows its present value
    Taken& default_str(const std::string& text);

   private:
    CLI::Option* option_;
  };

  CommandLine(const std::string& purpose, const std::string& program);
  ~CommandLine();

  // Declares an option `--name` (or, without dashes, a positional argument), the variable for its
  // value, and its text `what` in --help.
  Taken add_option(const std::string& name, double& value, const std::string& what);
  Taken add_option(const std::string& name, int& value, const std::string& what);
  Taken add_option(const std::string& name, std::string& value, const std::string& what);
  Taken add_option(const std::string& name, std::vector<double>& values, const std::string& what);
  Taken add_option(const std::string& name, std::vector<int>& values, const std::string& what);
  Taken add_option(const std::string& name, std::vector<std::string>& values,
                   const std::string& what);
  // The same; `take` is called with the value and may throw InvalidInput.
  Taken add_option_function(const std::string& name, const std::function<void(int)>& take,
                            const std::string& what);
  Taken add_option_function(const std::string& name,
                            const std::function<void(const std::string&)>& take,
                            const std::string& what);
  void add_flag(const std::string& name, bool& value, const std::string& what);
  void add_flag(const std::string& name, const std::string& what);
  void set_version(const std::string& version);

  // Reads the user's arguments into the variables. Returns the program's exit status if nothing
  // more is to be done, as after --help and --version. Throws InvalidInput.
  std::optional<int> parse(int argc, const char* const* argv);
  void parse(const std::string& options);

  std::string program() const;
  bool has(const std::string& option) const;
  // The options that were given with their values, in the order of declaration.
  std::vector<std::pair<std::string, std::vector<std::string>>> given() const;
  // Their names, repeated and in the order in which they were given.
  std::vector<std::string> order() const;

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace qddot::inline kit
