// Looks at what is said about bad data and bad usage.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace odobench::testing {

// The message of the Exception that action throws; empty when it throws none.
template <class Exception, class Action>
std::string refusal_of(Action action) {
  try {
    action();
  } catch (const Exception& e) {
    return e.what();
  }
  return "";
}
template <class Action>
std::string data_error(Action action) {
  return refusal_of<DataError>(action);
}
template <class Action>
std::string usage_error(Action action) {
  return refusal_of<std::invalid_argument>(action);
}

// Succeeds for one line that contains every part.
inline ::testing::AssertionResult says(const std::string& message, const std::vector<std::string>& parts) {
  if (message.empty()) return ::testing::AssertionFailure() << "no DataError";
  if (std::count(message.begin(), message.end(), '\n') != 0)
    return ::testing::AssertionFailure() << "more than one line: " << message;
  for (const std::string& part : parts)
    if (message.find(part) == std::string::npos)
      return ::testing::AssertionFailure() << "no \"" << part << "\" in: " << message;
  return ::testing::AssertionSuccess();
}

// `text` with the first `from` replaced; a test that replaces nothing would prove nothing.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) {
    ADD_FAILURE() << "nothing to replace: " << from;
    return text;
  }
  return text.replace(at, from.size(), to);
}

}  // namespace odobench::testing
