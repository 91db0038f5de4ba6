#include "datasets/logs/tables/json_paths.hpp"

#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "base/error.hpp"
#include "base/json_node.hpp"
#include "datasets/logs/log_names.hpp"

namespace odobench {
namespace {

constexpr std::size_t kListedElements = 16;

}  // namespace

std::size_t JsonPaths::new_node(std::size_t parent, const Node& node) {
  if (nodes_.size() > kMostColumns) {
    too_many_ = true;
    return kNone;
  }
  const std::size_t at = nodes_.size();
  nodes_.push_back(node);
  nodes_.back().parent = parent;
  nodes_.back().keep_text = node.keep_text || grow_;
  nodes_[parent].children.push_back(at);
  leaves_.emplace_back();
  return at;
}

std::size_t JsonPaths::member(std::size_t parent, std::string_view key, bool make) {
  Node& node = nodes_[parent];
  const std::size_t count = node.children.size();
  for (std::size_t k = 0; k < count; ++k) {
    std::size_t place = node.next_child + k;
    if (place >= count) place -= count;
    const std::size_t child = node.children[place];
    if (nodes_[child].in_array || nodes_[child].key != key) continue;
    node.next_child = place + 1 < count ? place + 1 : 0;
    return child;
  }
  if (!make) return kNone;
  Node fresh;
  fresh.key = key;
  return new_node(parent, fresh);
}

std::size_t JsonPaths::element(std::size_t parent, std::size_t index, bool make) {
  const std::vector<std::size_t>& children = nodes_[parent].children;
  if (index < children.size() && nodes_[children[index]].in_array && nodes_[children[index]].index == index)
    return children[index];
  for (const std::size_t child : children)
    if (nodes_[child].in_array && nodes_[child].index == index) return child;
  if (!make || (grow_ && index >= kListedElements)) return kNone;
  Node fresh;
  fresh.in_array = true;
  fresh.index = index;
  return new_node(parent, fresh);
}

std::size_t JsonPaths::add(std::string_view path, bool keep_text) {
  std::size_t node = 0;
  while (!path.empty() && node != kNone) {
    if (path.front() == '[') {
      std::size_t index = 0;
      const auto [end, error] = std::from_chars(path.data() + 1, path.data() + path.size(), index);
      if (error != std::errc() || end == path.data() + path.size() || *end != ']') return kNone;
      node = element(node, index, true);
      path.remove_prefix(static_cast<std::size_t>(end + 1 - path.data()));
      if (!path.empty() && path.front() == '.') path.remove_prefix(1);
      continue;
    }
    const std::size_t end = std::min(path.find_first_of(".["), path.size());
    node = member(node, path.substr(0, end), true);
    path.remove_prefix(end);
    if (!path.empty() && path.front() == '.') path.remove_prefix(1);
  }
  if (node != kNone && keep_text) nodes_[node].keep_text = true;
  return node;
}

std::string JsonPaths::path(std::size_t node) const {
  std::string text;
  for (; node != 0 && node != kNone; node = nodes_[node].parent) {
    const Node& at = nodes_[node];
    const std::string part = at.in_array ? fmt::format("[{}]", at.index) : at.key;
    text = part + (text.empty() || text.front() == '[' ? "" : ".") + text;
  }
  return text;
}

void JsonPaths::parse(std::string_view text, const std::string& file, std::size_t line) {
  levels_.clear();
  seen_.clear();
  key_node_ = kNone;
  line_ = static_cast<std::int64_t>(line);
  too_deep_ = too_many_ = false;
  const bool whole = nlohmann::json::sax_parse(text.begin(), text.end(), this);
  if (too_deep_)
    throw DataError(fmt::format("{}:{}: found a value nested deeper than {}", file, line, kDeepest));
  if (too_many_)
    throw DataError(
        fmt::format("{}:{}: found more than {} fields, expected fewer", file, line, kMostColumns));
  if (whole) return;
  parse_json(text, file, line);  // says what is wrong
  throw DataError(fmt::format("{}:{}: broken JSON", file, line));
}

// The node of the value that comes now.
std::size_t JsonPaths::take_node() {
  if (levels_.empty()) return 0;
  Level& level = levels_.back();
  if (!level.array) return key_node_;
  const std::size_t index = level.index++;
  return level.node == kNone ? kNone : element(level.node, index, grow_);
}

JsonLeaf* JsonPaths::take_leaf(JsonLeaf::Kind kind) {
  const std::size_t node = take_node();
  if (node == kNone) return nullptr;
  JsonLeaf& leaf = leaves_[node];
  leaf.kind = kind;
  leaf.line = line_;
  if (grow_) seen_.push_back(node);
  return &leaf;
}

bool JsonPaths::open(bool array) {
  if (levels_.size() >= kDeepest) {
    too_deep_ = true;
    return false;
  }
  const std::size_t node = take_node();
  levels_.push_back({node, array, 0});
  return !too_many_;
}

bool JsonPaths::close() {
  levels_.pop_back();
  return true;
}

bool JsonPaths::null() {
  take_leaf(JsonLeaf::Kind::Nothing);
  return !too_many_;
}

bool JsonPaths::boolean(bool value) {
  if (JsonLeaf* leaf = take_leaf(JsonLeaf::Kind::Bool)) {
    leaf->whole = value ? 1 : 0;
    leaf->real = value ? 1 : 0;
  }
  return !too_many_;
}

bool JsonPaths::number_integer(number_integer_t value) {
  if (JsonLeaf* leaf = take_leaf(JsonLeaf::Kind::Whole)) {
    leaf->whole = value;
    leaf->real = static_cast<double>(value);
  }
  return !too_many_;
}

bool JsonPaths::number_unsigned(number_unsigned_t value) {
  if (value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    return number_integer(static_cast<std::int64_t>(value));
  return number_float(static_cast<double>(value), std::to_string(value));
}

bool JsonPaths::number_float(number_float_t value, const string_t& digits) {
  const std::size_t node = take_node();
  if (node == kNone) return !too_many_;
  JsonLeaf& leaf = leaves_[node];
  leaf.kind = JsonLeaf::Kind::Real;
  leaf.line = line_;
  leaf.real = value;
  if (nodes_[node].keep_text) leaf.text = digits;
  if (grow_) seen_.push_back(node);
  return !too_many_;
}

bool JsonPaths::string(string_t& value) {
  const std::size_t node = take_node();
  if (node == kNone) return !too_many_;
  JsonLeaf& leaf = leaves_[node];
  leaf.kind = JsonLeaf::Kind::Text;
  leaf.line = line_;
  if (nodes_[node].keep_text) leaf.text = value;
  if (grow_) seen_.push_back(node);
  return !too_many_;
}

bool JsonPaths::binary(binary_t&) {
  return false;  // JSON text has none
}

bool JsonPaths::start_object(std::size_t) {
  return open(false);
}

bool JsonPaths::key(string_t& value) {
  const std::size_t node = levels_.back().node;
  key_node_ = node == kNone ? kNone : member(node, value, grow_);
  return !too_many_;
}

bool JsonPaths::end_object() {
  return close();
}

bool JsonPaths::start_array(std::size_t) {
  return open(true);
}

bool JsonPaths::end_array() {
  return close();
}

bool JsonPaths::parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) {
  return false;
}

}  // namespace odobench
