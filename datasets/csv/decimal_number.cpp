#include "datasets/csv/decimal_number.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>

namespace odobench {

std::optional<double> decimal_number(std::string_view text, char point) {
  constexpr std::size_t longest = 64;
  char with_point[longest];
  if (text.size() > longest) return std::nullopt;
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);  // none for from_chars
  if (point != '.') {
    if (text.find('.') != std::string_view::npos) return std::nullopt;
    const std::size_t mark = text.find(point);
    if (mark != std::string_view::npos) {
      std::copy(text.begin(), text.end(), with_point);
      with_point[mark] = '.';
      text = {with_point, text.size()};
    }
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace odobench
