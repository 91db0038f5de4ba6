// Model functions of the NIST regression problems with their exact first derivatives.
#pragma once

#include <string_view>

namespace odobench {

// f(b, x); with `gradient` also df/db into gradient[0..n-1]. x: the predictors. Where f overflows or is not
// defined, it and its derivatives are not finite.
using NistModel = double (*)(const double* b, const double* x, double* gradient);

// By the name of the problem; null for an unknown one.
NistModel nist_model(std::string_view problem);

}  // namespace odobench
