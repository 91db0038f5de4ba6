#include "datasets/logs/log_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "base/text.hpp"
#include "datasets/csv/column_name.hpp"
#include "datasets/csv/decimal_number.hpp"
#include "datasets/csv/decimal_time.hpp"

namespace odobench {
namespace {

constexpr std::string_view kMonths = "janfebmaraprmayjunjulaugsepoctnovdec";
constexpr std::int64_t kSecond_ns = 1'000'000'000;

// A calendar date and time of day, taken piece by piece off the front of a text.
class Clock {
 public:
  explicit Clock(std::string_view text) : rest_(text) {}

  // A pattern of strptime; false where the text does not follow it.
  bool take(std::string_view pattern) {
    for (std::size_t i = 0; i < pattern.size(); ++i) {
      if (pattern[i] == '%' && i + 1 < pattern.size()) {
        if (!take_part(pattern[++i])) return false;
      } else if (pattern[i] == ' ') {
        while (skip(' ')) continue;
      } else if (!skip(pattern[i])) {
        return false;
      }
    }
    return true;
  }
  bool skip(char c) {
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  bool done() const { return rest_.empty(); }
  bool take_fraction() {
    std::int64_t unit = kSecond_ns;
    const std::size_t before = rest_.size();
    for (fraction_ = 0; !rest_.empty() && is_digit(rest_.front()); rest_.remove_prefix(1)) {
      unit /= 10;  // digits finer than 1 ns count as 0
      fraction_ += unit * (rest_.front() - '0');
    }
    return rest_.size() < before;
  }
  // Z, +02, +0200, +02:00.
  bool take_zone() {
    if (skip('Z') || skip('z')) return true;
    const bool minus = skip('-');
    int hours = 0, minutes = 0;
    if ((!minus && !skip('+')) || !digits(2, 2, hours)) return false;
    const bool colon = skip(':');
    if (!digits(2, 2, minutes) && colon) return false;
    if (hours > 15 || minutes > 59) return false;
    zone_ = (minus ? -60 : 60) * (60 * hours + minutes);
    return true;
  }
  std::optional<std::int64_t> nanoseconds() const {
    using namespace std::chrono;
    const year_month_day date{year(year_), month(static_cast<unsigned>(month_)),
                              day(static_cast<unsigned>(day_))};
    // Within 126 years of 1970, so that nothing overflows.
    if (!date.ok() || year_ < 1850 || year_ > 2095 || hour_ > 23 || minute_ > 59 || second_ > 60)
      return std::nullopt;
    const std::int64_t days = sys_days(date).time_since_epoch().count() + (day_of_year_ - 1);
    const std::int64_t seconds = ((days * 24 + hour_) * 60 + minute_) * 60 + second_ - zone_;
    return seconds * kSecond_ns + fraction_;
  }

 private:
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }

  bool digits(int least, int most, int& value) {
    int count = 0, number = 0;
    for (; count < most && static_cast<std::size_t>(count) < rest_.size(); ++count) {
      const char c = rest_[static_cast<std::size_t>(count)];
      if (!is_digit(c)) break;
      number = 10 * number + (c - '0');
    }
    if (count < least) return false;
    value = number;
    rest_.remove_prefix(static_cast<std::size_t>(count));
    return true;
  }
  bool take_month_name() {
    if (rest_.size() < 3) return false;
    std::string name(rest_.substr(0, 3));
    for (char& c : name) c = static_cast<char>(c | 0x20);
    const std::size_t at = kMonths.find(name);
    if (at == std::string_view::npos || at % 3 != 0) return false;
    month_ = static_cast<int>(at / 3) + 1;
    rest_.remove_prefix(3);
    return true;
  }
  bool take_part(char part) {
    switch (part) {
      case 'Y':
        return digits(4, 4, year_);
      case 'm':
        return digits(1, 2, month_);
      case 'd':
        return digits(1, 2, day_);
      case 'H':
        return digits(1, 2, hour_);
      case 'M':
        return digits(1, 2, minute_);
      case 'S':
        return digits(1, 2, second_);
      case 'j':
        return digits(1, 3, day_of_year_) && day_of_year_ >= 1 && day_of_year_ <= 366;
      case 'f':
        return take_fraction();
      case 'b':
        return take_month_name();
      case 'z':
        return take_zone();
      case 'F':
        return take("%Y-%m-%d");
      case 'T':
        return take("%H:%M:%S");
      case '%':
        return skip('%');
      default:
        return false;
    }
  }

  std::string_view rest_;
  int year_ = 1970, month_ = 1, day_ = 1, day_of_year_ = 1, hour_ = 0, minute_ = 0, second_ = 0, zone_ = 0;
  std::int64_t fraction_ = 0;
};

int digits_of_unit(std::string_view unit) {
  if (unit == "s") return 9;
  if (unit == "ms") return 6;
  if (unit == "us") return 3;
  return unit == "ns" ? 0 : -1;
}

void require_pattern(const std::string& pattern) {
  constexpr std::string_view known = "YmdHMSfjbzFT%";
  bool any = false;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '%') continue;
    ++i;
    if (i == pattern.size() || known.find(pattern[i]) == std::string_view::npos)
      throw std::invalid_argument(fmt::format(
          "time_unit: found \"%{}\" in \"{}\", expected %Y %m %d %H %M %S %f %j %b %z %F %T or %%",
          shown(std::string_view(pattern).substr(i, 1)), shown(pattern)));
    any = any || pattern[i] != '%';
  }
  if (!any)
    throw std::invalid_argument(
        fmt::format("time_unit: found \"{}\", expected s, ms, us, ns, iso8601 or a pattern such as "
                    "\"%Y-%m-%d %H:%M:%S.%f\"",
                    shown(pattern)));
}

bool is_unit_of_time(std::string_view unit) {
  return digits_of_unit(unit) >= 0;
}

// Numbers near the Unix time of our days (1980 to 2096), with a step between 10 us and 100 s.
std::string unix_unit(double last, double step) {
  double scale = 1;
  for (const char* unit : {"s", "ms", "us", "ns"}) {
    if (last >= 3e8 * scale && last < 4e9 * scale && step >= 1e-5 * scale && step <= 100 * scale) return unit;
    scale *= 1000;
  }
  return "";
}

std::string unit_of_step(double step) {
  if (step >= 1e-3 && step < 1) return "s";
  if (step > 1 && step < 1e3) return "ms";
  if (step > 1e3 && step < 1e6) return "us";
  return step > 1e6 ? "ns" : "";
}

}  // namespace

TimeUnit::TimeUnit(std::string unit) : unit_(std::move(unit)), digits_(digits_of_unit(unit_)) {
  if (digits_ < 0 && unit_ != "iso8601") require_pattern(unit_);
}

std::string TimeUnit::text() const {
  if (digits_ >= 0) return "a time in " + unit_;
  return unit_ == "iso8601" ? "a time of ISO 8601" : fmt::format("a time as \"{}\"", shown(unit_));
}

std::optional<std::int64_t> TimeUnit::of(std::string_view text) const {
  if (digits_ >= 0) return decimal_nanoseconds(text, digits_);
  if (unit_ == "iso8601") return iso8601_nanoseconds(text);
  Clock clock(text);
  if (!clock.take(unit_) || !clock.done()) return std::nullopt;
  return clock.nanoseconds();
}

std::optional<std::int64_t> TimeUnit::of(std::int64_t number) const {
  constexpr std::array<std::int64_t, 10> powers{1,       10,        100,        1000,        10'000,
                                                100'000, 1'000'000, 10'000'000, 100'000'000, 1'000'000'000};
  if (digits_ < 0) return std::nullopt;
  const std::int64_t factor = powers[static_cast<std::size_t>(digits_)];
  const std::int64_t most = kLargestStamp_ns / factor;
  if (number > most || number < -most) return std::nullopt;
  return number * factor;
}

std::optional<std::int64_t> TimeUnit::of(double number) const {
  if (digits_ < 0) return std::nullopt;
  // The product of a long double (64 bits of mantissa) with 1e9 rounds once, below 1 ns.
  const long double ns = static_cast<long double>(number) * std::pow(10.0L, digits_);
  if (!(std::abs(ns) <= static_cast<long double>(kLargestStamp_ns))) return std::nullopt;
  return std::llround(ns);
}

std::optional<std::int64_t> iso8601_nanoseconds(std::string_view text) {
  Clock clock(text);
  if (!clock.take("%Y-%m-%d")) return std::nullopt;
  if (!clock.done()) {
    if (!clock.skip('T') && !clock.skip('t') && !clock.skip(' ')) return std::nullopt;
    if (!clock.take("%H:%M")) return std::nullopt;
    if (clock.skip(':') && !clock.take("%S")) return std::nullopt;
    if ((clock.skip('.') || clock.skip(',')) && !clock.take_fraction()) return std::nullopt;
    clock.skip(' ');
    if (!clock.done() && !(clock.take_zone() && clock.done())) return std::nullopt;
  }
  return clock.nanoseconds();
}

std::string time_unit_of_name(std::string_view name) {
  const std::string unit = column_name(name).unit;
  return is_unit_of_time(unit) ? unit : "";
}

bool name_tells_time(std::string_view name) {
  const ColumnName column = column_name(name);
  return is_unit_of_time(column.unit) || (column.meaning == Meaning::Time && column.unit.empty());
}

std::string time_unit_of_values(const std::vector<std::string>& values) {
  std::vector<double> steps;
  double last = 0;
  std::size_t dates = 0, numbers = 0;
  for (const std::string& value : values) {
    if (iso8601_nanoseconds(value)) ++dates;
    std::optional<double> number = decimal_number(value, '.');
    if (!number) number = decimal_number(value, ',');
    if (!number || !std::isfinite(*number)) continue;
    if (numbers++ > 0) steps.push_back(*number - last);
    last = *number;
  }
  if (dates == values.size() && dates > 0) return "iso8601";
  if (numbers != values.size() || steps.size() < 2) return "";
  if (std::any_of(steps.begin(), steps.end(), [](double step) { return step < 0; })) return "";
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  const std::string near_today = unix_unit(last, *middle);
  return near_today.empty() ? unit_of_step(*middle) : near_today;
}

}  // namespace odobench
