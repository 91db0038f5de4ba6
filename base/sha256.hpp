// SHA-256 (FIPS 180-4) as 64 lower-case hexadecimal digits, the form of sha256sum.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace odobench {

std::string sha256(std::string_view bytes);

// Throws DataError when the file cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

// True for 64 lower-case hexadecimal digits.
bool is_sha256(std::string_view text);

}  // namespace odobench
