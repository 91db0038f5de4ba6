#include "datasets/logs/arrays/array_catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.hpp"
#include "base/text.hpp"
#include "datasets/logs/log_time.hpp"

namespace odobench {
namespace {

constexpr std::size_t kVectorSamples = 50;

// "ticks" of ticks_t, ticks_time_ns, ticks/t: what stands before the last word of a name that tells time.
std::string time_prefix(const std::string& name) {
  for (std::size_t at = name.size(); at-- > 1;) {
    if (name[at] != '_' && name[at] != '/' && name[at] != '.') continue;
    const std::string last = name.substr(at + 1);
    if (last.empty() || (at + 1 < name.size() && time_unit_of_name(last) == last))
      continue;  // the "ns" of t_ns
    return name_tells_time(last) ? name.substr(0, at) : "";
  }
  return "";
}

template <class Number>
void follow(Number now, bool begin, Number& first, Number& last, Number& largest) {
  if (begin) first = last = now;
  Number step = 0;
  if constexpr (std::is_integral_v<Number>) {
    if (__builtin_sub_overflow(now, last, &step)) step = 0;
  } else {
    step = now - last;
  }
  if (step > largest) largest = step;
  last = now;
}

}  // namespace

std::string field_path(const ArrayInfo& array, std::size_t column) {
  if (array.field.empty()) return fmt::format("#{}", column + 1);
  return array.head.columns == 1 ? array.field : fmt::format("{}[{}]", array.field, column);
}

bool ArrayCatalogue::begin(const ArrayHead& head) {
  fields_ += head.columns;
  if (fields_ > kMostFields)
    throw DataError(fmt::format("{}: found more than {} fields, expected fewer", file_, kMostFields));
  arrays_.emplace_back();
  arrays_.back().head = head;
  arrays_.back().first.resize(std::min<std::size_t>(head.columns, head.rows == 0 ? 0 : head.columns));
  taken_ = 0;
  return true;
}

void ArrayCatalogue::numbers(const std::int64_t* whole, const double* real, std::size_t count) {
  ArrayInfo& array = arrays_.back();
  const ArrayHead& head = array.head;
  array.whole = whole != nullptr;
  const auto text = [&](std::size_t i) {
    return whole != nullptr ? std::to_string(whole[i]) : fmt::format("{}", real[i]);
  };
  // Only these are looked at; of the rest nothing is known but the steps of a vector.
  if (head.by_rows) {
    for (std::size_t i = 0; i < count && taken_ + i < array.first.size(); ++i)
      array.first[taken_ + i] = text(i);
  } else if (head.rows > 0) {
    for (std::size_t i = (head.rows - taken_ % head.rows) % head.rows; i < count; i += head.rows)
      if ((taken_ + i) / head.rows < array.first.size()) array.first[(taken_ + i) / head.rows] = text(i);
  }
  if (head.columns == 1) {
    for (std::size_t i = 0; i < count && array.samples.size() < kVectorSamples; ++i)
      array.samples.push_back(text(i));
    for (std::size_t i = 0; i < count; ++i) {
      const bool begin = taken_ + i == 0;
      if (whole != nullptr)
        follow(whole[i], begin, array.first_whole, array.last_whole, array.largest_whole);
      else
        follow(real[i], begin, array.first_real, array.last_real, array.largest_real);
    }
  }
  taken_ += count;
}

void ArrayCatalogue::skip(const std::string& name, const std::string& reason) {
  if (skipped_.size() < kMostFields) skipped_.emplace_back(name, reason);
}

void ArrayCatalogue::group(ArrayGrouping grouping) {
  if (arrays_.empty() && !skipped_.empty())
    throw DataError(fmt::format("{}: {}: {}", file_, shown(skipped_[0].first), skipped_[0].second));
  if (arrays_.empty()) throw DataError(fmt::format("{}: found no array of numbers, expected one", file_));
  std::set<std::string> prefixes;
  for (const ArrayInfo& array : arrays_)
    if (array.head.columns == 1) prefixes.insert(time_prefix(array.head.name));
  prefixes.erase("");
  for (ArrayInfo& array : arrays_) {
    const std::string& name = array.head.name;
    std::size_t length = 0;
    if (grouping == ArrayGrouping::Structs) {
      const std::size_t dot = name.find('.');
      length = dot == std::string::npos ? 0 : dot;
    } else {
      for (const std::string& prefix : prefixes)
        if (prefix.size() > length && name.size() > prefix.size() + 1 &&
            name.substr(0, prefix.size()) == prefix &&
            std::string_view("_/.").find(name[prefix.size()]) != std::string_view::npos)
          length = prefix.size();
    }
    array.source = name.substr(0, length);
    array.field = length == 0 ? name : name.substr(length + 1);
  }
}

std::vector<std::string> ArrayCatalogue::sources() const {
  std::vector<std::string> names;
  for (const ArrayInfo& array : arrays_)
    if (std::find(names.begin(), names.end(), array.source) == names.end()) names.push_back(array.source);
  return names;
}

std::vector<std::string> ArrayCatalogue::fields(const std::string& source) const {
  std::vector<std::string> paths;
  for (const ArrayInfo& array : arrays_)
    for (std::size_t c = 0; array.source == source && c < array.head.columns; ++c)
      paths.push_back(field_path(array, c));
  return paths;
}

std::optional<std::size_t> ArrayCatalogue::time(const std::string& source, std::string& unit) const {
  for (const bool named : {true, false})
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
      const ArrayInfo& array = arrays_[i];
      if (array.source != source || array.head.columns != 1 || array.head.rows < 2) continue;
      const std::string name = array.field.substr(array.field.find_last_of('.') + 1);
      if (named && !name_tells_time(name)) continue;
      std::string found = named ? time_unit_of_name(name) : "";
      if (found.empty()) found = time_unit_of_values(array.samples);
      if (found.empty()) continue;
      unit = found;
      return i;
    }
  return std::nullopt;
}

LogSource ArrayCatalogue::describe(const std::string& name) const {
  LogSource source;
  source.name = name;
  source.type = "array";
  for (const ArrayInfo& array : arrays_) {
    if (array.source != name) continue;
    if (array.head.name.find('.') != std::string::npos) source.type = "struct";
    for (std::size_t c = 0; c < array.head.columns; ++c)
      source.fields.push_back(
          {field_path(array, c), name_of(array.head.type), c < array.first.size() ? array.first[c] : ""});
    source.rows = std::max(source.rows, static_cast<std::int64_t>(array.head.rows));
  }
  std::string unit_name;
  const std::optional<std::size_t> at = time(name, unit_name);
  if (!at) return source;
  const ArrayInfo& array = arrays_[*at];
  const TimeUnit unit(unit_name);
  source.rows = static_cast<std::int64_t>(array.head.rows);
  const auto stamp = [&](std::int64_t whole, double real) {
    return (array.whole ? unit.of(whole) : unit.of(real)).value_or(0);
  };
  source.first_ns = stamp(array.first_whole, array.first_real);
  source.last_ns = stamp(array.last_whole, array.last_real);
  source.largest_gap_ns = stamp(array.largest_whole, array.largest_real);
  return source;
}

}  // namespace odobench
