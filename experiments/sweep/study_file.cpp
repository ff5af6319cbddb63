#include "experiments/sweep/study_file.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/scene_choice.hpp"
#include "experiments/sweep/scene_entries.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/text_file.hpp"
#include "qddot/scene/toml_table.hpp"

namespace qddot::sweep {
namespace {

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
