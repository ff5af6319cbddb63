#include "experiments/kit/csv.hpp"

#include <cmath>
#include <iterator>

#include <fmt/compile.h>
#include <nlohmann/json.hpp>

namespace qddot::inline kit {

Csv::Csv(const std::vector<std::string>& header) {
  for (const auto& name : header) field(name);
  end_row();
}

void Csv::field(double value) {
  separate();
  if (std::isfinite(value))
    fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{:.17g}"), value);
}

void Csv::field(std::string_view text) {
  separate();
  if (text.find_first_of(",\"\r\n") == text.npos) {
    text_.append(text.data(), text.data() + text.size());
    return;
  }
  text_.push_back('"');
  for (const char c : text) {
    if (c == '"') text_.push_back('"');
    text_.push_back(c);
  }
  text_.push_back('"');
}

void Csv::end_row() {
  text_.push_back('\n');
  row_is_empty_ = true;
}

std::string sidecar_of(const std::string& path) {
  return (path.ends_with(".csv") ? path.substr(0, path.size() - 4) : path) + ".json";
}

std::string text_of_sidecar(const nlohmann::json& origin) {
  // A path in a command line may hold bytes that are no UTF-8.
  return origin.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

CsvFile::CsvFile(const std::string& path, const std::vector<std::string>& header)
    : Csv(header), file_(path, std::string(text()), sidecar_of(path)), sidecar_(sidecar_of(path)) {}

void CsvFile::complete(const nlohmann::json& origin) {
  flush();
  sidecar_.write(text_of_sidecar(origin));
  file_.complete();
  sidecar_.complete();
}

void CsvFile::commit() {
  file_.commit();
  sidecar_.commit();
}

}  // namespace qddot::inline kit
