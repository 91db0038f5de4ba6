// A direction.
#pragma once

namespace odobench {

// Which of two numbers of a kind is the better one, if that can be said.
enum class Better { None, Lower, Higher };

}  // namespace odobench
