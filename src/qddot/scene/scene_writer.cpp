#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/scene_file.hpp"

namespace qddot {
namespace {

// False for -0, which must be written.
bool is_plain_zero(double x) { return std::bit_cast<std::uint64_t>(x) == 0; }

bool is_plain_zero(const Eigen::Vector3d& x) {
  return is_plain_zero(x[0]) && is_plain_zero(x[1]) && is_plain_zero(x[2]);
}

// The number of bytes of the UTF-8 sequence at the start of `text`; 0 if there is none.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  if (first > 0xf4 || length == 0 || text.size() < length) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if (byte(k) < 0x80 || byte(k) > 0xbf) return 0;
  }
  // Wrong are overlong forms, halves of surrogate pairs, and code points above U+10FFFF.
  const bool wrong = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xed && byte(1) > 0x9f) ||
                     (first == 0xf0 && byte(1) < 0x90) || (first == 0xf4 && byte(1) > 0x8f);
  return wrong ? 0 : length;
}

class TomlText {
 public:
  void add(std::string_view text) { text_.append(text); }

  // `key = "text"`
  void line(std::string_view key, std::string_view value) {
    add_key(key);
    text_.push_back('"');
    // Reading refuses a line of many dots, which may separate keys: they are written as escapes.
    const bool hides_dots = std::ranges::count(value, '.') > 20;
    while (!value.empty()) {
      const std::size_t length = sequence_length(value);
      if (length == 0)
        add("\ufffd");
      else
        add_character(value.substr(0, length), hides_dots);
      value.remove_prefix(std::max<std::size_t>(length, 1));
    }
    add("\"\n");
  }
  void line(std::string_view key, double value) {
    add_key(key);
    add_number(value);
    text_.push_back('\n');
  }
  // The first `size` components.
  void line(std::string_view key, const Eigen::Vector3d& value, int size) {
    add_key(key);
    for (int k = 0; k < size; ++k) {
      add(k == 0 ? "[" : ", ");
      add_number(value[k]);
    }
    add("]\n");
  }

  void line(std::string_view key, const std::vector<double>& values) {
    add_key(key);
    const char* before = "[";
    for (const double value : values) {
      add(std::exchange(before, ", "));
      add_number(value);
    }
    add("]\n");
  }
  // Vectors in brackets, each of `size` components.
  void list(const std::vector<Eigen::Vector3d>& values, int size) {
    const char* before = "[";
    for (const Eigen::Vector3d& value : values) {
      add(std::exchange(before, ", "));
      for (int k = 0; k < size; ++k) {
        add(k == 0 ? "[" : ", ");
        add_number(value[k]);
      }
      add("]");
    }
    add("]");
  }

  std::size_t size() const { return text_.size(); }
  std::string text() const { return fmt::to_string(text_); }

 private:
  void add_key(std::string_view key) {
    add(key);
    add(" = ");
  }
  // The shortest number that reads back as the same; never an integer, which has no -0.
  void add_number(double x) {
    const std::size_t start = text_.size();
    fmt::format_to(std::back_inserter(text_), "{}", x);
    const std::string_view digits(text_.data() + start, text_.size() - start);
    if (digits.find_first_of(".e") == digits.npos) add(".0");
  }
  void add_character(std::string_view character, bool hides_dots) {
    const auto c = static_cast<unsigned char>(character[0]);
    if (c == '"' || c == '\\') text_.push_back('\\');
    if (c < ' ' || c == 0x7f || (c == '.' && hides_dots))
      fmt::format_to(std::back_inserter(text_), "\\u{:04X}", c);
    else
      add(character);
  }

  fmt::memory_buffer text_;
};

void add_node(const Node& node, int dimension, TomlText& out) {
  out.add("\n[[nodes]]\n");
  out.line("position", node.position, dimension);
  if (!is_plain_zero(node.velocity)) out.line("velocity", node.velocity, dimension);
  out.line("mass", node.mass);
  if (node.pinned) out.add("pinned = true\n");
  if (!is_plain_zero(node.load)) out.line("load", node.load, dimension);
  if (node.curve >= 0) {
    out.line(node.pinned ? "motion" : "load_in_time", fmt::format("curve {}", node.curve));
  }
}

// Under the name "curve <number>".
void add_curve(const TimeCurve& curve, int number, int dimension, TomlText& out) {
  out.add("\n[[curves]]\n");
  out.line("name", fmt::format("curve {}", number));
  if (!curve.polynomial.empty()) {
    out.add("polynomial = ");
    out.list(curve.polynomial, dimension);
    out.add("\n");
  }
  for (const TimeCurve::Harmonic& harmonic : curve.harmonics) {
    out.add("[[curves.harmonics]]\n");
    out.line("amplitude", harmonic.amplitude, dimension);
    out.line("angular_frequency", harmonic.frequency);
    out.line("phase", harmonic.phase);
  }
  for (const PiecewiseCubic& table : curve.tables) {
    out.add("[curves.table]\n");
    out.line("times", table.times());
    out.add("values = ");
    out.list(table.values(), dimension);
    out.add("\n");
    out.line("interpolation", table.is_straight() ? "linear" : "spline");
  }
}

void add_spring(const Spring& spring, TomlText& out) {
  if (spring.law.rigid) return;
  out.add(fmt::format("\n[[springs]]\nnodes = [{}, {}]\n", spring.nodes[0], spring.nodes[1]));
  out.line("stiffness", spring.law.stiffness);
  out.line("rest_length", spring.law.rest_length);
  if (!is_plain_zero(spring.law.quartic)) out.line("quartic", spring.law.quartic);
  if (!is_plain_zero(spring.law.damping)) out.line("damping", spring.law.damping);
  if (!is_plain_zero(spring.law.cubic)) out.line("cubic", spring.law.cubic);
  if (spring.law.can_break()) out.line("breaks_at", spring.law.breaks_at);
  if (spring.law.pulls_only) out.add("pulls_only = true\n");
}

void add_rod(const Spring& spring, TomlText& out) {
  if (!spring.law.rigid) return;
  out.add(fmt::format("\n[[rods]]\nnodes = [{}, {}]\n", spring.nodes[0], spring.nodes[1]));
  out.line("length", spring.law.rest_length);
}

// A file has no functions of the caller's own, and one table a curve.
void require_writable(const Scene& scene, std::size_t curve) {
  if (scene.curves[curve].own.empty() && scene.curves[curve].tables.size() <= 1) return;
  throw InvalidInput(fmt::format(
      "scene {}: curves[{}] has functions of the caller's own, or several tables; allowed in a "
      "scene file are polynomials, harmonics and one table",
      shown(scene.name), curve));
}

}  // namespace

std::string to_toml(const Scene& scene, std::size_t most) {
  TomlText out;
  const auto require_readable = [&] {
    if (out.size() > most)
      throw InvalidInput(
          fmt::format("scene {}: it takes more than {} MB as a text; allowed are scenes of less",
                      shown(scene.name), static_cast<double>(most) / 1e6));
  };
  out.line("name", scene.name);
  out.add(fmt::format("dimension = {}\n", scene.dimension));
  out.line("gravity", scene.gravity, scene.dimension);
  if (scene.until) out.line("until", *scene.until);
  out.line("start", scene.starts_at_equilibrium ? "equilibrium" : "drawn");
  if (scene.stiff_above) out.line("stiff_above", *scene.stiff_above);
  if (!is_plain_zero(scene.air_damping)) out.line("air_damping", scene.air_damping);
  if (scene.gravity_curve >= 0)
    out.line("gravity_in_time", fmt::format("curve {}", scene.gravity_curve));
  for (std::size_t i = 0; i < scene.curves.size(); ++i) {
    require_writable(scene, i);
    add_curve(scene.curves[i], static_cast<int>(i), scene.dimension, out);
    require_readable();
  }
  for (const Node& node : scene.nodes) {
    add_node(node, scene.dimension, out);
    require_readable();
  }
  for (const auto add : {add_spring, add_rod}) {
    for (const Spring& spring : scene.springs) {
      add(spring, out);
      require_readable();
    }
  }
  return out.text();
}

}  // namespace qddot
