#include "problems/information/formula.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/text.hpp"

namespace odobench {
namespace {

using Lookup = std::function<std::optional<Quantity>(const std::string& name)>;

constexpr std::size_t kLongest = 1000;
constexpr int kDeepest = 100;
constexpr const char* kSymbols[] = {"m", "rad", "s"};

const Dimension kNone = Dimension::Zero();

// factor of b's gradient on top of a's, either of which may be empty.
Vector combined(double a_factor, const Vector& a, double b_factor, const Vector& b) {
  if (a.size() == 0) return b.size() == 0 ? b : Vector(b_factor * b);
  if (b.size() == 0) return a_factor * a;
  return a_factor * a + b_factor * b;
}

Quantity sum_of(const Quantity& a, const Quantity& b, double sign) {
  Quantity out{a.value + sign * b.value, combined(1, a.gradient, sign, b.gradient), a.dimension,
               a.literal && b.literal};
  if (a.literal) out.dimension = b.dimension;
  const bool fit =
      a.literal || b.literal || (a.dimension && b.dimension && (*a.dimension == *b.dimension).all());
  if (!fit) out.dimension.reset();
  return out;
}

Quantity product_of(const Quantity& a, const Quantity& b) {
  Quantity out{
      a.value * b.value, combined(b.value, a.gradient, a.value, b.gradient), {}, a.literal && b.literal};
  if (a.dimension && b.dimension) out.dimension = *a.dimension + *b.dimension;
  return out;
}

Quantity power_of(const Quantity& a, double exponent) {
  const double slope = exponent == 0 ? 0 : exponent * std::pow(a.value, exponent - 1);
  Quantity out{std::pow(a.value, exponent), combined(slope, a.gradient, 0, {}), {}, a.literal};
  if (a.dimension) out.dimension = exponent * *a.dimension;
  return out;
}

class Parser {
 public:
  Parser(const std::string& text, const Lookup& find, const std::vector<std::string>& known)
      : text_(text), find_(find), known_(known) {}

  Quantity whole() {
    Quantity value = sum();
    if (at_ < text_.size()) refuse("an operator or the end");
    return value;
  }

 private:
  [[noreturn]] void refuse(const std::string& expected) const {
    const std::string found =
        at_ < text_.size() ? fmt::format("'{}'", shown(text_.substr(at_), 20)) : std::string("the end");
    throw std::invalid_argument(
        fmt::format("'{}': at character {}: found {}, expected {}", shown(text_), at_ + 1, found, expected));
  }

  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  char next() {
    skip_blanks();
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(char wanted) {
    if (next() != wanted) return false;
    ++at_;
    skip_blanks();
    return true;
  }

  Quantity sum() {
    Quantity value = product();
    for (;;) {
      if (take('+'))
        value = sum_of(value, product(), 1);
      else if (take('-'))
        value = sum_of(value, product(), -1);
      else
        return value;
    }
  }

  Quantity product() {
    Quantity value = factor();
    for (;;) {
      if (take('*'))
        value = product_of(value, factor());
      else if (take('/'))
        value = product_of(value, power_of(factor(), -1));
      else
        return value;
    }
  }

  Quantity factor() {
    if (++depth_ > kDeepest) refuse(fmt::format("at most {} brackets and signs within each other", kDeepest));
    Quantity value;
    if (take('-')) {
      value = factor();
      value.value = -value.value;
      value.gradient = -value.gradient;
    } else if (take('+')) {
      value = factor();
    } else {
      value = atom();
      const std::size_t exponent_at = at_;
      if (take('^')) {
        const Quantity exponent = factor();
        if (!exponent.literal) {
          at_ = exponent_at;
          refuse("an exponent without parameters");
        }
        value = power_of(value, exponent.value);
      }
    }
    --depth_;
    return value;
  }

  Quantity bracket() {
    Quantity value = sum();
    if (!take(')')) refuse("')'");
    return value;
  }

  Quantity atom() {
    const char first = next();
    if (take('(')) return bracket();
    if (std::isdigit(static_cast<unsigned char>(first)) != 0 || first == '.') return number();
    if (std::isalpha(static_cast<unsigned char>(first)) == 0 && first != '_')
      refuse("a number, a name or '('");
    return named();
  }

  Quantity number() {
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) refuse("a number");
    at_ = static_cast<std::size_t>(end - text_.data());
    skip_blanks();
    return {value, {}, kNone, true};
  }

  Quantity named() {
    const std::size_t begin = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_'))
      ++at_;
    const std::string name = text_.substr(begin, at_ - begin);
    skip_blanks();
    if ((name == "sqrt" || name == "abs") && take('(')) {
      const Quantity of = bracket();
      if (name == "sqrt") return power_of(of, 0.5);
      return of.value < 0 ? product_of({-1, {}, kNone, true}, of) : of;
    }
    std::optional<Quantity> found = find_(name);
    if (!found) {
      at_ = begin;
      refuse(fmt::format("one of {}", fmt::join(known_, ", ")));
    }
    return *std::move(found);
  }

  const std::string& text_;
  const Lookup& find_;
  const std::vector<std::string>& known_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

std::string stripped(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

std::optional<Dimension> dimension_of(const std::string& unit) {
  const std::size_t slash = unit.find('/');
  Dimension out = kNone;
  const auto add = [&](const std::string& symbol, double power) {
    for (Eigen::Index k = 0; k < 3; ++k)
      if (symbol == kSymbols[k]) {
        out[k] += power;
        return true;
      }
    return symbol.empty();
  };
  const bool known = add(unit.substr(0, slash), 1) &&
                     (slash == std::string::npos || (slash > 0 && add(unit.substr(slash + 1), -1)));
  return known ? std::optional<Dimension>(out) : std::nullopt;
}

std::string unit_of(const Dimension& dimension) {
  std::string above, below;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (dimension[k] == 0) continue;
    std::string& side = dimension[k] > 0 ? above : below;
    const double power = std::abs(dimension[k]);
    side += fmt::format("{}{}{}", side.empty() ? "" : " ", kSymbols[k],
                        power == 1 ? "" : fmt::format("^{:g}", power));
  }
  if (below.empty()) return above;
  return fmt::format("{}/{}", above.empty() ? "1" : above, below);
}

Formula named_formula(const std::string& text) {
  if (text.size() > kLongest)
    throw std::invalid_argument(
        fmt::format("'{}': {} characters, expected at most {}", shown(text), text.size(), kLongest));
  const std::size_t equals = text.find('=');
  Formula out{stripped(text.substr(0, equals)),
              stripped(equals == std::string::npos ? text : text.substr(equals + 1))};
  if (out.name.empty() || out.text.empty())
    throw std::invalid_argument(
        fmt::format("'{}': found nothing, expected a formula of parameters, e.g. (r1+r2)/2 or mean=(r1+r2)/2",
                    shown(text)));
  return out;
}

Quantity evaluate(const Formula& formula, const Lookup& find, const std::vector<std::string>& known) {
  Quantity value = Parser(formula.text, find, known).whole();
  if (!std::isfinite(value.value) || !value.gradient.allFinite())
    throw std::invalid_argument(
        fmt::format("'{}': its value or its derivatives are not a finite number here", shown(formula.text)));
  return value;
}

}  // namespace odobench
