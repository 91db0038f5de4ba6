// Where the checkout lies. One function, so that no other file depends on that folder: a compiler cache then
// serves every checkout.
#pragma once

#include <filesystem>

namespace odobench::testing {

std::filesystem::path source_dir();

}  // namespace odobench::testing

namespace odobench {
using testing::source_dir;  // most tests call it by its bare name
}
