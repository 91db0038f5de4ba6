#include "bench/studies/entropy/entropy_output.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <utility>

namespace odobench {
namespace {

constexpr std::size_t kPiece = 1 << 16;

std::string header(int samples, bool with_time) {
  std::string text = "Laikas,enc1_po,enc2_po,enc3_po,enc4_po,,ax_po,ay_po,,theta_po,";
  for (int w = 1; w <= 4; ++w) text += fmt::format(",enc{}x_po,enc{}y_po", w, w);
  text += ",H,iterations,r1,sx1,sy1";
  for (int i = 0; i < increment_count(samples); ++i) text += fmt::format(",t{}", i);
  return text + (with_time ? ",time_s\n" : "\n");
}

}  // namespace

FilterOutputFile::FilterOutputFile(const std::filesystem::path& file, Existing existing,
                                   TextSink standard_output, int samples, bool with_time,
                                   double rotation_sign)
    : to_standard_output_(file == "-"),
      standard_output_(std::move(standard_output)),
      transaction_(existing),
      with_time_(with_time),
      rotation_sign_(rotation_sign) {
  if (to_standard_output_)
    buffer_ = header(samples, with_time);
  else
    transaction_.add(file, header(samples, with_time));
}

void FilterOutputFile::flush() {
  if (to_standard_output_)
    standard_output_(buffer_);
  else
    transaction_.append(buffer_);
  buffer_.clear();
}

// Shortest text that reads back as the same number, and a comma.
void FilterOutputFile::put(double value) {
  if (value == 0 || value == 1 || value == -1) {  // most of them: t
    buffer_ += value == 0 ? "0," : value > 0 ? "1," : "-1,";
    return;
  }
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  buffer_.append(text, end);
  buffer_ += ',';
}

void FilterOutputFile::put(std::int64_t value) {
  char text[24];
  buffer_.append(text, std::to_chars(text, text + sizeof text, value).ptr);
  buffer_ += ',';
}

void FilterOutputFile::add(const FilterOutput& output, double time_s) {
  put(output.index);
  for (std::size_t w = 0; w < 4; ++w) put(std::hypot(output.first.x[w], output.first.y[w]));
  buffer_ += ',';
  put(output.state.ax12);
  put(output.state.ay12);
  buffer_ += ',';
  put(rotation_sign_ * output.first.rotation);
  buffer_ += ',';
  for (std::size_t w = 0; w < 4; ++w) {
    put(output.first.x[w]);
    put(output.first.y[w]);
  }
  put(output.hamiltonian);
  put(static_cast<std::int64_t>(output.search.iterations));
  put(output.state.r1);
  put(output.state.sx1);
  put(output.state.sy1);
  for (const double t : output.t) put(t);
  if (with_time_) put(time_s);
  buffer_.back() = '\n';
  if (buffer_.size() >= kPiece) flush();
}

void FilterOutputFile::commit() {
  flush();
  if (!to_standard_output_) transaction_.commit();
}

}  // namespace odobench
