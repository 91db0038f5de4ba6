#include "problems/calibration/losses/loss.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "base/names.hpp"
#include "base/text.hpp"

namespace odobench {
namespace {

constexpr std::array<std::string_view, 4> kLossNames = {"squared", "huber", "cauchy", "tukey"};

LossValue huber(double s, double d) {
  if (!(s > d * d)) return {s, 1, 1, 0};
  const double root = std::sqrt(s);
  return {2 * d * root - d * d, d / root, 0, 0};
}

LossValue cauchy(double s, double d) {
  const double v = s / (d * d);
  return {d * d * std::log1p(v), 1 / (1 + v), 0, 0};
}

LossValue tukey(double s, double d) {
  const double v = s / (d * d);
  if (v >= 1) return {d * d / 3, 0, 0, 0};
  return {s * (1 - v + v * v / 3), (1 - v) * (1 - v), 0, 0};
}

[[noreturn]] void refuse(std::string_view text, const std::string& why) {
  throw std::invalid_argument(
      fmt::format("--loss={}: {}; expected squared, huber, cauchy or tukey, then =TUNING and :recording as "
                  "needed",
                  shown(std::string(text)), why));
}

}  // namespace

std::string_view name_of(LossKind kind) {
  return kLossNames[static_cast<std::size_t>(kind)];
}

LossValue Loss::at(double s) const {
  LossValue value{s, 1, 1, 0};
  switch (kind) {
    case LossKind::Squared:
      return value;
    case LossKind::Huber:
      value = huber(s, tuning);
      break;
    case LossKind::Cauchy:
      value = cauchy(s, tuning);
      break;
    case LossKind::Tukey:
      value = tukey(s, tuning);
      break;
  }
  if (s == 0) return {0, 1, 1, 0};
  // f^2 = rho / s, so 2 f f' = (rho' - f^2) / s; what cancels in it is multiplied by s wherever it is used.
  value.factor = std::sqrt(value.rho / s);
  value.slope = (value.weight - value.rho / s) / (2 * value.factor * s);
  return value;
}

double usual_tuning(LossKind kind, LossScope scope) {
  switch (kind) {
    case LossKind::Squared:
      return 0;
    case LossKind::Huber:
      return scope == LossScope::Sample ? 1.345 : 1.5;
    case LossKind::Cauchy:
      return scope == LossScope::Sample ? 2.385 : 1.5;
    case LossKind::Tukey:
      return scope == LossScope::Sample ? 4.685 : 4.0;
  }
  return 0;
}

std::string Loss::name() const {
  if (!robust()) return "squared";
  return fmt::format("{}={:.6g}{}", name_of(kind), tuning, scope == LossScope::Recording ? ":recording" : "");
}

std::string Loss::text() const {
  if (!robust()) return name();
  if (scope == LossScope::Recording) return fmt::format("{}, scale={:.10g}", name(), position_scale);
  return fmt::format("{}, scale={:.10g}:{:.10g}", name(), position_scale, heading_scale);
}

Loss parse_loss(std::string_view text) {
  Loss loss;
  std::string_view rest = text;
  if (const std::size_t colon = rest.find(':'); colon != std::string_view::npos) {
    const std::string_view scope = rest.substr(colon + 1);
    if (scope != "recording" && scope != "sample")
      refuse(text, fmt::format("'{}' is neither sample nor recording", shown(std::string(scope))));
    loss.scope = scope == "recording" ? LossScope::Recording : LossScope::Sample;
    rest = rest.substr(0, colon);
  }
  const std::size_t equals = rest.find('=');
  const std::string name(rest.substr(0, equals));
  const auto found = std::find(kLossNames.begin(), kLossNames.end(), name);
  if (found == kLossNames.end())
    refuse(text, fmt::format("unknown loss '{}'{}", shown(name),
                             did_you_mean(name, {kLossNames.begin(), kLossNames.end()})));
  loss.kind = static_cast<LossKind>(found - kLossNames.begin());
  loss.tuning = usual_tuning(loss.kind, loss.scope);
  if (!loss.robust() && rest.size() != text.size()) refuse(text, "the squared loss knows no groups");
  if (equals == std::string_view::npos) return loss;
  const std::string number(rest.substr(equals + 1));
  char* end = nullptr;
  loss.tuning = std::strtod(number.c_str(), &end);
  if (number.empty() || *end != '\0' || !std::isfinite(loss.tuning) || loss.tuning < 1e-6 ||
      loss.tuning > 1e6)
    refuse(text, fmt::format("tuning constant '{}', expected a number from 1e-6 to 1e6", shown(number)));
  if (!loss.robust()) refuse(text, "the squared loss has no tuning constant");
  return loss;
}

}  // namespace odobench
