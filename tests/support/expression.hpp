// Value of a formula as text, such as "b1*(1-exp(-b2*x))", in long double: numbers, names, + - * / ^,
// parentheses and the functions exp, cos, sin, atan; pi. Written for the models of NIST's regression
// problems, which the program computes by functions of its own.
#pragma once

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

namespace odobench::testing {

class Expression {
 public:
  explicit Expression(std::string text) : text_(std::move(text)) {}

  // Throws std::invalid_argument on what it does not understand.
  long double operator()(const std::map<std::string, long double>& values) {
    values_ = &values;
    at_ = 0;
    const long double value = sum();
    if (at_ != text_.size()) refuse();
    return value;
  }

 private:
  [[noreturn]] void refuse() const {
    throw std::invalid_argument("'" + text_ + "', column " + std::to_string(at_ + 1));
  }
  bool take(char c) {
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  long double sum() {
    long double value = product();
    for (;;) {
      if (take('+'))
        value += product();
      else if (take('-'))
        value -= product();
      else
        return value;
    }
  }
  long double product() {
    long double value = signed_power();
    for (;;) {
      if (take('*'))
        value *= signed_power();
      else if (take('/'))
        value /= signed_power();
      else
        return value;
    }
  }
  long double signed_power() {
    if (take('-')) return -signed_power();
    const long double base = primary();
    return take('^') ? std::pow(base, signed_power()) : base;
  }
  long double primary() {
    if (take('(')) return closed(sum());
    if (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_]))) {
      char* end = nullptr;
      const long double value = std::strtold(text_.c_str() + at_, &end);
      at_ = static_cast<std::size_t>(end - text_.c_str());
      return value;
    }
    std::string name;
    while (at_ < text_.size() && std::isalnum(static_cast<unsigned char>(text_[at_]))) name += text_[at_++];
    if (take('(')) {
      const long double argument = closed(sum());
      if (name == "exp") return std::exp(argument);
      if (name == "cos") return std::cos(argument);
      if (name == "sin") return std::sin(argument);
      if (name == "atan") return std::atan(argument);
      refuse();
    }
    if (name == "pi") return std::numbers::pi_v<long double>;
    const auto found = values_->find(name);
    if (found == values_->end()) refuse();
    return found->second;
  }
  long double closed(long double value) {
    if (!take(')')) refuse();
    return value;
  }

  std::string text_;
  std::size_t at_ = 0;
  const std::map<std::string, long double>* values_ = nullptr;
};

}  // namespace odobench::testing
