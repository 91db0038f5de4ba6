#include "reports/render/latex_text.hpp"

#include <array>
#include <cctype>
#include <map>
#include <utility>

namespace odobench {
namespace {

// Order matters only in that no key is a prefix of another.
constexpr std::array<std::pair<std::string_view, std::string_view>, 36> kReplacements{{
    {"\\", "\\textbackslash{}"},
    {"{", "\\{"},
    {"}", "\\}"},
    {"$", "\\$"},
    {"&", "\\&"},
    {"#", "\\#"},
    {"%", "\\%"},
    {"_", "\\_"},
    {"~", "\\textasciitilde{}"},
    {"^", "\\textasciicircum{}"},
    {"<", "\\textless{}"},
    {">", "\\textgreater{}"},
    {"|", "\\textbar{}"},
    {"\"", "\\textquotedbl{}"},
    {"\n", " "},
    {"\r", ""},
    {"–", "--"},
    {"θ", "$\\theta$"},
    {"σ", "$\\sigma$"},
    {"Σ", "$\\Sigma$"},
    {"Δ", "$\\Delta$"},
    {"×", "$\\times$"},
    {"±", "$\\pm$"},
    {"≤", "$\\leq$"},
    {"≥", "$\\geq$"},
    {"µ", "$\\mu$"},
    {"°", "$^\\circ$"},
    {"²", "$^2$"},
    {"√", "$\\surd$"},
    {"∞", "$\\infty$"},
    {"·", "$\\cdot$"},
    {"→", "$\\to$"},
    {"≈", "$\\approx$"},
    {"…", "\\ldots{}"},
    {"Ψ", "$\\Psi$"},
    {"Γ", "$\\Gamma$"},
}};

}  // namespace

std::string latex_text(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    bool replaced = false;
    for (const auto& [from, to] : kReplacements) {
      if (text.substr(0, from.size()) != from) continue;
      out += to;
      text.remove_prefix(from.size());
      replaced = true;
      break;
    }
    if (replaced) continue;
    out += text.front();
    text.remove_prefix(1);
  }
  return out;
}

std::string breakable_latex(const std::string& text) {
  std::string out, word;
  for (const char c : text) {
    word += c;
    const bool stop = c == '/' || c == ',' || c == '_' || c == '|' || c == ':';
    if (!stop) continue;
    out += latex_text(word) + "\\allowbreak{}";
    word.clear();
  }
  return out + latex_text(word);
}

std::string latex_unit(const std::string& unit) {
  static const std::map<std::string, std::string> known{{"m", "\\metre"},
                                                        {"mm", "\\milli\\metre"},
                                                        {"rad", "\\radian"},
                                                        {"deg", "\\degree"},
                                                        {"s", "\\second"},
                                                        {"us", "\\micro\\second"},
                                                        {"%", "\\percent"},
                                                        {"V", "\\volt"},
                                                        {"m/s", "\\metre\\per\\second"},
                                                        {"rad/s", "\\radian\\per\\second"},
                                                        {"m/s^2", "\\metre\\per\\second\\squared"},
                                                        {"deg/s^2", "\\degree\\per\\second\\squared"}};
  const auto found = known.find(unit);
  return found == known.end() ? latex_text(unit) : "\\unit{" + found->second + "}";
}

std::string latex_label(const std::string& id) {
  std::string out;
  for (char c : id) out += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == ':' ? c : '-';
  return out;
}

}  // namespace odobench
