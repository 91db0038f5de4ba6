// Numbers that somebody makes of parameters: "(r1 + r2) / 2", with their derivatives and units.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "problems/matrices.hpp"

namespace odobench {

// Powers of metre, radian and second.
using Dimension = Eigen::Array3d;
// Of "", "m", "rad", "s", "m/m", "m/rad", "rad/m", "rad/s", "m/s"; nothing for others.
std::optional<Dimension> dimension_of(const std::string& unit);
// "m", "m/rad", "m^2"; "" of a number.
std::string unit_of(const Dimension& dimension);

// A value with its gradient by n parameters. A number that stands in the formula fits every dimension.
struct Quantity {
  double value = 0;
  Vector gradient;                     // n, or empty: 0
  std::optional<Dimension> dimension;  // nothing: not known (a sum of different ones)
  bool literal = false;                // made of numbers alone
};

// A formula, with its own name: "mean radius=(r1+r2)/2", or without: the text itself is the name.
//
//   sum     = product {("+" | "-") product}
//   product = factor {("*" | "/") factor}
//   factor  = ("+" | "-") factor | atom ["^" factor]       the exponent without parameters
//   atom    = number | name | "(" sum ")" | ("sqrt" | "abs") "(" sum ")"
//
// Names are letters, digits and '_', not beginning with a digit; blanks count for nothing.
struct Formula {
  std::string name, text;
};
// At most 1,000 characters. Throws std::invalid_argument for an empty name or text.
Formula named_formula(const std::string& text);

// The value by the quantities that `find` knows. Throws std::invalid_argument "TEXT: at character 4: found
// '..', expected .." where the text is no formula, for a name that `find` does not know, of which `known` is
// said, for more than 100 brackets or signs within each other, and "TEXT: ... not a finite number" where the
// value or its gradient is none.
Quantity evaluate(const Formula& formula,
                  const std::function<std::optional<Quantity>(const std::string& name)>& find,
                  const std::vector<std::string>& known);

}  // namespace odobench
