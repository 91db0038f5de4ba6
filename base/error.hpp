// What a reader throws about bad data: one line "file:line: what was found, what was expected".
#pragma once

#include <stdexcept>
#include <string>

namespace odobench {

class DataError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace odobench
