// The columns of a recording by name, in the order in which files hold them, and what every one must satisfy.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

#include "datasets/recording.hpp"

namespace odobench {

// The name of a signal's column: the signal's own, but in files of schema 1, which know one robot,
// "steering_1" for "steering.1" and "wheel_speed_1" for "wheel.1".
std::string column_name(const Signal& signal, int schema);

// Calls visit(name, unit, std::vector<double>&) for x, y, theta and the signals (time_us is apart: it holds
// integers).
template <class R, class Visit>
void for_each_value_column(R& recording, int schema, Visit visit) {
  visit(std::string("x"), "m", recording.reference.x);
  visit(std::string("y"), "m", recording.reference.y);
  visit(std::string("theta"), "rad", recording.reference.theta);
  for (auto& signal : recording.signals)
    visit(column_name(signal, schema), unit_of(signal.kind), signal.values);
}

inline std::size_t value_columns(const Recording& recording) {
  return 3 + recording.signals.size();
}

// The first thing wrong with a recording's columns.
struct ColumnFault {
  std::string column;                 // as above, or "time_us"
  std::optional<std::size_t> sample;  // 0-based; none when the column as a whole is wrong
  std::string what;                   // "found nan, expected a finite number"
};

// At least two samples, all columns equally long, stamps from 0 strictly increasing, values finite; a
// reference at some stamps only: at increasing stamps of the recording, at least one.
std::optional<ColumnFault> find_fault(const Recording& recording, int schema);

// Stamps without a reference are not-a-number in x, y and theta, in files and on the way from and to them.
// The first makes them of the reference's list of stamps; the second makes the list where all three are
// not-a-number at some stamp (one alone is left for find_fault()).
Recording with_reference_everywhere(const Recording& recording);
void drop_missing_reference(Recording& recording);

}  // namespace odobench
