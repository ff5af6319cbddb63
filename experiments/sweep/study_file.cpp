#include "experiments/sweep/study_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/scene_choice.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/text_file.hpp"
#include "qddot/scene/toml_table.hpp"

namespace qddot::sweep {
namespace {

constexpr int most_draws = 100000, largest_seed = 2000000000;

// A parameter of a generator: values that multiply, or a range that is drawn from.
struct Parameter {
  std::string name;
  std::vector<double> values;  // none where it is drawn
  double from = 0, to = 0;
  bool is_log = false, is_whole = false;

  bool is_drawn() const { return values.empty(); }
  // The value at a part of the way from the one to the other.
  double at(double part) const {
    const double x = is_log ? from * std::pow(to / from, part) : from + (to - from) * part;
    return is_whole ? std::round(x) : x;
  }
};

// A list of numbers, each once; nothing for anything else.
std::vector<double> list_in(const toml::array& array) {
  std::vector<double> values;
  for (const toml::node& node : array) {
    const auto value = finite_number(node);
    if (!value || std::ranges::find(values, *value) != values.end()) return {};
    values.push_back(*value);
  }
  return values;
}

// { from, to } and either a count of values or, where scenes are drawn, none.
Parameter range_in(const TomlTable& range, const std::string& name, bool is_drawn) {
  if (is_drawn) {
    range.allow_keys({"from", "to", "spacing"});
  } else {
    range.allow_keys({"from", "to", "count", "spacing"});
  }
  Parameter p{.name = name, .values = {}, .from = range.number("from"), .to = range.number("to")};
  const std::string spacing = range.has("spacing") ? range.text("spacing") : "linear";
  if (spacing != "linear" && spacing != "log") range.refuse("spacing", "\"linear\" and \"log\"");
  p.is_log = spacing == "log";
  if (p.is_log && !(p.from > 0 && p.to > 0))
    range.refuse("spacing", "\"log\" where both ends are above 0");
  if (p.from == p.to) range.refuse("to", "numbers unlike from");
  if (is_drawn) return p;
  const int count = range.integer("count", 2, most_draws);
  for (int i = 0; i < count; ++i) p.values.push_back(i);
  return p;
}

std::vector<Parameter> parameters_in(const TomlTable& entry, const toml::table& table,
                                     const Generator& generator, bool is_drawn) {
  std::vector<Parameter> parameters;
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    if (name == "generator" || name == "until" || name == "draws" || name == "seed") continue;
    const auto known = std::ranges::find(generator.parameters, name, &GeneratorParameter::name);
    if (known == generator.parameters.end()) {
      std::vector<std::string> names;
      for (const GeneratorParameter& one : generator.parameters) names.push_back(one.name);
      entry.fail(name, fmt::format("it is no parameter of {}; allowed are {}", generator.name,
                                   fmt::join(names, ", ")));
    }
    Parameter p{.name = name, .values = {}};
    if (const auto value = finite_number(node)) {
      p.values = {*value};
    } else if (const toml::array* list = node.as_array()) {
      p.values = list_in(*list);
      if (p.values.empty()) entry.refuse(name, "lists of one or more finite numbers, each once");
    } else if (node.is_table()) {
      p = range_in(entry.table(name), name, is_drawn);
      p.is_whole = known->whole;
      const double last = static_cast<double>(p.values.size()) - 1;
      for (double& x : p.values) x = p.at(x / last);
      p.values.erase(std::unique(p.values.begin(), p.values.end()), p.values.end());
    } else {
      entry.refuse(name, "numbers, lists of them and ranges { from, to, count, spacing }");
    }
    parameters.push_back(std::move(p));
  }
  return parameters;
}

// The digits that a label shows, 1e6 and not 1e+06.
std::string shown(double value) {
  std::string text = fmt::format("{:.6g}", value);
  const std::size_t at = text.find('e');
  if (at == text.npos) return text;
  const bool is_negative = text[at + 1] == '-';
  const std::size_t digits = text.find_first_not_of("+-0", at + 1);
  return text.substr(0, at + 1) + (is_negative ? "-" : "") + text.substr(digits);
}

std::string text_of(const std::string& name, const Generator& generator,
                    const std::map<std::string, double>& values) {
  std::string text =
      fmt::format("name = \"{}\"\n[generator]\nkind = \"{}\"\n", name, generator.name);
  for (const auto& [key, value] : values) {
    const auto known = std::ranges::find(generator.parameters, key, &GeneratorParameter::name);
    text += known->whole && value == std::round(value) && std::abs(value) < 1e15
                ? fmt::format("{} = {:.0f}\n", key, value)
                : fmt::format("{} = {:#.17g}\n", key, value);
  }
  return text;
}

// One scene of a generator: `values` of all parameters that are given, `varied` those of them that
// tell it from others.
StudyScene generated(const Generator& generator, const std::map<std::string, double>& values,
                     const std::map<std::string, double>& varied) {
  StudyScene scene{.label = generator.name, .source = generator.name, .text = {}};
  std::string name = generator.name;
  for (const auto& [key, value] : varied) {
    scene.label += fmt::format("_{}={}", key, shown(value));
    name += fmt::format(" {}={}", key, shown(value));
  }
  scene.varied = varied;
  if (!values.empty()) scene.text = text_of(name, generator, values);
  return scene;
}

// How many combinations the lists have.
double product(const std::vector<Parameter>& parameters) {
  double count = 1;
  for (const Parameter& p : parameters) {
    if (!p.is_drawn()) count *= static_cast<double>(p.values.size());
  }
  return count;
}

// A number in [0, 1) from a generator that is the same on every machine.
double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

std::vector<StudyScene> all_generated(const Generator& generator,
                                      const std::vector<Parameter>& parameters, int draws,
                                      int seed) {
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  std::vector<StudyScene> scenes;
  const auto count = static_cast<std::size_t>(product(parameters));
  for (std::size_t i = 0; i < count; ++i) {
    for (int draw = 0; draw < draws; ++draw) {
      std::map<std::string, double> values, varied;
      std::size_t rest = i;
      for (const Parameter& p : parameters) {
        const std::size_t index = p.is_drawn() ? 0 : rest % p.values.size();
        if (!p.is_drawn()) rest /= p.values.size();
        values[p.name] = p.is_drawn() ? p.at(unit(random)) : p.values[index];
        if (p.is_drawn() || p.values.size() > 1) varied[p.name] = values[p.name];
      }
      scenes.push_back(generated(generator, values, varied));
    }
  }
  return scenes;
}

std::vector<StudyScene> of_generator(const TomlTable& entry, const toml::table& table,
                                     double most) {
  const std::string kind = entry.text("generator");
  const Generator* generator = find_generator(kind);
  if (!generator) {
    std::vector<std::string> names;
    for (const Generator& one : generators()) names.push_back(one.name);
    entry.refuse("generator", fmt::format("{}", fmt::join(names, ", ")));
  }
  const bool is_drawn = entry.has("draws");
  if (!is_drawn && entry.has("seed")) entry.refuse("draws", "whole numbers, where seed is given");
  const auto parameters = parameters_in(entry, table, *generator, is_drawn);
  const int draws = is_drawn ? entry.integer("draws", 1, most_draws) : 1;
  if (is_drawn && std::ranges::none_of(parameters, &Parameter::is_drawn))
    entry.refuse("draws", "those of a scene with a range { from, to }");
  const int seed = entry.has("seed") ? entry.integer("seed", 0, largest_seed) : 0;
  if (const double count = product(parameters) * draws; count > most) {
    entry.fail("generator", fmt::format("its lists multiply to {:g} scenes; allowed are {:g} in "
                                        "all",
                                        count, most));
  }
  return all_generated(*generator, parameters, draws, seed);
}

// The numbers above 0 at a key: one, or a list of at least one, each once; none where it is
// missing.
std::vector<double> positive_numbers(const TomlTable& table, const toml::table& values,
                                     std::string_view key) {
  const toml::node* node = values.get(key);
  if (!node) return {};
  std::vector<double> numbers;
  if (const auto number = finite_number(*node)) numbers = {*number};
  if (const toml::array* array = node->as_array()) numbers = list_in(*array);
  if (numbers.empty() || std::ranges::any_of(numbers, [](double x) { return !(x > 0); }))
    table.refuse(key, "finite numbers above 0, and lists of one or more of them, each once");
  return numbers;
}

// The scenes of one table of a study's list of scenes: { file = ... } or { generator = ... }, whose
// lists and ranges multiply. `horizons` [s] are the end times if the table has no `until`. Throws
// InvalidInput if the table is wrong, or if it would make more than `most` scenes.
std::vector<StudyScene> scenes_of(const TomlTable& entry, const toml::table& table,
                                  const std::vector<double>& horizons, double most) {
  std::vector<StudyScene> drawn;
  if (entry.has("generator") == entry.has("file")) {
    throw InvalidInput(
        fmt::format("{}: a scene is of a generator or of a file; allowed is exactly one of the two",
                    entry.place()));
  }
  if (entry.has("file")) {
    entry.allow_keys({"file", "until"});
    drawn.push_back({.label = {}, .source = entry.text("file"), .text = {}});
  } else {
    drawn = of_generator(entry, table, most);
  }
  std::vector<double> own = positive_numbers(entry, table, "until");
  if (own.empty()) own = horizons;
  if (own.empty()) return drawn;
  std::vector<StudyScene> scenes;
  for (const StudyScene& one : drawn) {
    for (const double until : own) {
      StudyScene scene = one;
      scene.until = until;
      if (own.size() > 1) scene.varied["until"] = until;
      scenes.push_back(std::move(scene));
    }
  }
  return scenes;
}

// A program whose studies can be divided, and whether it takes scenes and methods.
struct Divisible {
  std::string_view name;
  bool takes_scenes, takes_methods;
};
constexpr std::array programs = {
    Divisible{"work_precision", true, true}, Divisible{"stability_map", true, true},
    Divisible{"energy_drift", true, true}, Divisible{"crossover", false, true},
    Divisible{"advice", false, false}};

// The options that sweep itself gives to the programs.
constexpr std::array own_options = {"out",   "scene",    "methods",   "accuracies", "until",
                                    "share", "journal",  "kept",      "resume",     "list-shares",
                                    "force", "progress", "time-limit"};

const Divisible& program_in(const TomlTable& file) {
  const std::string name = file.has("program") ? file.text("program") : "work_precision";
  const auto found = std::ranges::find(programs, name, &Divisible::name);
  if (found != programs.end()) return *found;
  std::vector<std::string_view> names;
  for (const Divisible& one : programs) names.push_back(one.name);
  file.refuse("program", fmt::format("{}", fmt::join(names, ", ")));
}

std::vector<std::string> methods_in(const TomlTable& file, const toml::table& table) {
  if (!file.has("methods")) return {};
  std::vector<std::string> methods;
  const toml::array* array = table["methods"].as_array();
  if (!array || array->empty()) file.refuse("methods", "lists of one or more methods");
  for (const toml::node& node : *array) {
    const auto* name = node.as_string();
    if (const std::string why = name ? why_not_built(name->get()) : ""; !why.empty())
      file.fail("methods", why);
    if (!name || !find_method(name->get()))
      file.refuse("methods", fmt::format("lists of {}", kit::method_names()));
    if (std::ranges::find(methods, name->get()) != methods.end())
      file.fail("methods", fmt::format("{} is named twice; allowed is once", name->get()));
    methods.push_back(name->get());
  }
  return methods;
}

// A number or text as a command line has it; a list joined by commas.
std::string word_of(const TomlTable& options, std::string_view key, const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* flag = node.as_boolean(); flag && flag->get()) return {};
  const toml::array* array = node.as_array();
  if (!array || array->empty())
    options.refuse(key, "numbers, quoted texts, true, and lists of one or more of these");
  std::vector<std::string> words;
  for (const toml::node& entry : *array) {
    if (entry.is_array()) options.refuse(key, "lists of numbers and texts");
    words.push_back(word_of(options, key, entry));
  }
  return fmt::format("{}", fmt::join(words, ","));
}

std::vector<std::pair<std::string, std::string>> options_in(const TomlTable& file,
                                                            const toml::table& table,
                                                            bool may_name_until) {
  std::vector<std::pair<std::string, std::string>> options;
  if (!file.has("options")) return options;
  const TomlTable given = file.table("options");
  for (const auto& [key, node] : *table["options"].as_table()) {
    const std::string name(key.str());
    const bool is_own = std::ranges::find(own_options, name) != own_options.end();
    if (is_own && !(name == "until" && may_name_until))
      given.fail(name, "sweep itself gives it; allowed are the other options of the program");
    options.emplace_back(name, word_of(given, name, node));
  }
  return options;
}

// One of a list of scenes: a name, or a table.
void add_entry(const TomlTable& file, const std::string& path, const toml::node& node,
               const std::vector<double>& horizons, std::size_t entry, StudyFile& study) {
  const std::string place = fmt::format("scenes[{}]", entry);
  std::vector<StudyScene> scenes;
  if (const auto* name = node.as_string()) {
    toml::table one;
    one.insert(find_generator(name->get()) ? "generator" : "file", name->get());
    scenes = scenes_of(TomlTable(one, path, place), one, horizons, most_scenes);
  } else if (const auto* table = node.as_table()) {
    scenes = scenes_of(TomlTable(*table, path, place), *table, horizons,
                       most_scenes - static_cast<double>(study.scenes.size()));
  } else {
    file.refuse("scenes", "lists of names of generators or files, and of tables");
  }
  if (study.scenes.size() + scenes.size() > most_scenes)
    file.fail("scenes", fmt::format("they are more than {:g}; allowed are fewer", most_scenes));
  for (StudyScene& scene : scenes) {
    scene.entry = entry;
    study.scenes.push_back(std::move(scene));
  }
}

// A folder's name of what a file is called, or a label of a generator.
std::string label_of(const StudyScene& scene) {
  std::string label = scene.label;
  if (label.empty()) label = std::filesystem::path(scene.source).stem().string();
  if (scene.varied.contains("until")) label += fmt::format("_until={:.6g}", scene.until);
  std::ranges::replace_if(
      label, [](unsigned char c) { return c <= ' ' || c == 0x7f || c == '/'; }, '_');
  while (label.starts_with('.')) label.erase(0, 1);
  constexpr std::size_t longest = 100;
  return label.empty() ? "scene" : label.substr(0, longest);
}

// Gives every scene a label of its own, and none that sweep's own folders have.
void label_all(std::vector<StudyScene>& scenes) {
  std::set<std::string> taken = {"tasks", "scenes", "log", "machines"};
  for (StudyScene& scene : scenes) {
    const std::string first = label_of(scene);
    scene.label = first;
    for (int n = 2; !taken.insert(scene.label).second; ++n)
      scene.label = fmt::format("{}-{}", first, n);
  }
}

}  // namespace

StudyFile read_study(const std::string& path) {
  const toml::table table = parse_toml(read_text(path), path);
  const TomlTable file(table, path);
  file.allow_keys({"program", "until", "methods", "accuracies", "scenes", "options"});
  const Divisible& program = program_in(file);
  StudyFile study{.program = std::string(program.name)};
  study.methods = methods_in(file, table);
  if (!study.methods.empty() && !program.takes_methods)
    file.fail("methods", fmt::format("{} takes none; allowed is to leave them out", program.name));
  study.accuracies = positive_numbers(file, table, "accuracies");
  if (!study.accuracies.empty() && program.name != "work_precision")
    file.fail("accuracies", "only work_precision takes them; allowed is to leave them out");
  if (std::ranges::any_of(study.accuracies, [](double x) { return x < 1e-14 || x >= 1; }))
    file.refuse("accuracies", "numbers from 1e-14 to below 1, each once");
  study.options = options_in(file, table, !program.takes_scenes);
  if (!program.takes_scenes) {
    for (const char* key : {"scenes", "until"}) {
      if (file.has(key)) {
        file.fail(key, fmt::format("{} draws scenes of its own; allowed is to leave it out",
                                   program.name));
      }
    }
    study.scenes = {{.label = study.program, .source = {}, .text = {}}};
    return study;
  }
  const toml::array* scenes = table["scenes"].as_array();
  if (!scenes || scenes->empty()) file.refuse("scenes", "lists of one or more scenes");
  const auto horizons = positive_numbers(file, table, "until");
  for (std::size_t i = 0; i < scenes->size(); ++i)
    add_entry(file, path, (*scenes)[i], horizons, i, study);
  label_all(study.scenes);
  return study;
}

}  // namespace qddot::sweep
