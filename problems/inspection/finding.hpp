// What is said of a data set before anything is fitted to it: findings, and the kinds that there are.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace odobench::inspection {

// error: what it says decides the fit, so that a calibration is meaningless as the set stands; warning: it
// biases the fit; note: it is worth knowing.
enum class Severity { Error, Warning, Note };

// "error", "warning", "note".
std::string_view name_of(Severity severity);

struct Kind {
  std::string_view name;  // "wheel_reversed"
  Severity severity;      // the usual one; single findings may be milder
  bool mendable;          // mend() knows what to do about it
  std::string_view fix;   // what to do about it, for people; no full stop
};

// In the order in which a set is looked at.
std::span<const Kind> kinds();
// Throws std::invalid_argument for an unknown name, with the nearest one.
const Kind& kind_called(std::string_view name);

struct Finding {
  Severity severity = Severity::Warning;
  std::string kind;
  std::string recording = {};                        // "": of the whole set
  std::size_t wheel = 0;                             // of the table, from 1; 0: of none
  std::optional<std::size_t> sample = {};            // where it is one
  std::optional<std::size_t> first = {}, last = {};  // where it is a stretch
  std::map<std::string, double> figures = {};        // SI units and radians unless the name says otherwise
  std::string message = {};                          // no full stop
  bool mendable = false;
  std::string signal = {};  // the drive signal that it is about, where the wheel is not enough

  std::string_view fix() const { return kind_called(kind).fix; }
};

// With severity and remedy of the kind.
Finding finding_of(std::string_view kind, std::string message, std::map<std::string, double> figures = {});

bool any_error(const std::vector<Finding>& findings);

}  // namespace odobench::inspection
