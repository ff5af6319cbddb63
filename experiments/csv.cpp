#include "experiments/csv.hpp"

namespace qddot {

Csv::Csv(const std::vector<std::string>& header) {
  for (const auto& name : header) field(name);
  end_row();
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

}  // namespace qddot
