#include "experiments/kit/command_line.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {
namespace {

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

}  // namespace

using Taken = CommandLine::Taken;

Taken& Taken::take_last() {
  option_->take_last();
  return *this;
}
Taken& Taken::take_each() {
  option_->expected(1)->take_all();
  return *this;
}
Taken& Taken::delimiter(char c) {
  option_->delimiter(c);
  return *this;
}
Taken& Taken::capture_default_str() {
  option_->capture_default_str();
  return *this;
}
Taken& Taken::default_str(const std::string& text) {
  option_->default_str(text);
  return *this;
}

CommandLine::CommandLine(const std::string& purpose, const std::string& program)
    : app_(std::make_unique<CLI::App>(purpose, program)) {}

CommandLine::~CommandLine() = default;

Taken CommandLine::add_option(const std::string& name, double& value, const std::string& what) {
  return Taken(app_->add_option(name, value, what));
}
Taken CommandLine::add_option(const std::string& name, int& value, const std::string& what) {
  return Taken(app_->add_option(name, value, what));
}
Taken CommandLine::add_option(const std::string& name, std::string& value,
                              const std::string& what) {
  return Taken(app_->add_option(name, value, what));
}
Taken CommandLine::add_option(const std::string& name, std::vector<double>& values,
                              const std::string& what) {
  return Taken(app_->add_option(name, values, what));
}
Taken CommandLine::add_option(const std::string& name, std::vector<int>& values,
                              const std::string& what) {
  return Taken(app_->add_option(name, values, what));
}
Taken CommandLine::add_option(const std::string& name, std::vector<std::string>& values,
                              const std::string& what) {
  return Taken(app_->add_option(name, values, what));
}
Taken CommandLine::add_option_function(const std::string& name,
                                       const std::function<void(int)>& take,
                                       const std::string& what) {
  return Taken(app_->add_option_function<int>(name, take, what));
}
Taken CommandLine::add_option_function(const std::string& name,
                                       const std::function<void(const std::string&)>& take,
                                       const std::string& what) {
  return Taken(app_->add_option_function<std::string>(name, take, what));
}
void CommandLine::add_flag(const std::string& name, bool& value, const std::string& what) {
  app_->add_flag(name, value, what);
}
void CommandLine::add_flag(const std::string& name, const std::string& what) {
  app_->add_flag(name)->description(what);
}
void CommandLine::set_version(const std::string& version) {
  app_->set_version_flag("--version", version);
}

std::optional<int> CommandLine::parse(int argc, const char* const* argv) {
  try {
    in_one_sentence([&] { app_->parse(argc, argv); });
  } catch (const CLI::Success& help) {
    return app_->exit(help);
  }
  return {};
}

void CommandLine::parse(const std::string& options) {
  in_one_sentence([&] { app_->parse(options); });
}

std::string CommandLine::program() const { return app_->get_name(); }

bool CommandLine::has(const std::string& option) const { return app_->count(option) > 0; }

std::vector<std::pair<std::string, std::vector<std::string>>> CommandLine::given() const {
  std::vector<std::pair<std::string, std::vector<std::string>>> all;
  for (const CLI::Option* option : std::as_const(*app_).get_options()) {
    if (option->count() > 0) all.emplace_back(option->get_name(), option->results());
  }
  return all;
}

std::vector<std::string> CommandLine::order() const {
  std::vector<std::string> names;
  for (const CLI::Option* option : app_->parse_order()) names.push_back(option->get_name());
  return names;
}

}  // namespace qddot::inline kit
