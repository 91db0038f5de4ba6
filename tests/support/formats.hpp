// Every format that the program reads: valid examples, and the commands that read a file of it. For mutations
// and fuzzing.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/support/run_process.hpp"

namespace odobench::testing {

using Words = std::vector<std::string>;

struct Format {
  std::string name;
  std::function<std::vector<std::string>()> examples;
  // Puts `bytes` into files of `folder`; the commands that read them. What they write goes to `folder`/out.
  std::function<std::vector<Words>(const std::string& bytes, const TemporaryFolder& folder)> commands;
  bool binary = false;  // numbers stand in it as bytes: any of them may be a nan
};
const std::vector<Format>& formats();
std::vector<std::string> format_names();
// Throws std::invalid_argument.
const Format& format_called(const std::string& name);

// True for a control character other than the end of a line, a character that turns the direction of writing,
// or a byte that is not UTF-8.
bool unprintable(const std::string& text);

// What a user must never see of a command that read such a file, whatever its bytes are: "" or what is wrong.
// Exit codes other than 0, 1, 2, 3; more or less than one line of error; control characters or invalid UTF-8;
// nan or inf where there is no error and none in the input; temporary files left behind, or anything at all
// after an error.
std::string complaint_about(const ProcessResult& result, const TemporaryFolder& folder,
                            const std::string& input, bool binary = false);

}  // namespace odobench::testing
