#include "datasets/logs/ros/messages/message_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <stdexcept>

#include "base/names.hpp"
#include "base/text.hpp"
#include "datasets/logs/ros/messages/message_path.hpp"

namespace odobench {
namespace {

constexpr std::size_t kLeavesInMessages = 40;

// A value that is wanted, and how far its path has been followed.
struct Want {
  const std::vector<PathStep>* path;
  std::size_t at;
  PlanTarget target;

  const PathStep& step() const { return (*path)[at]; }
  bool last() const { return at + 1 == path->size(); }
  Want deeper() const { return {path, at + 1, target}; }
};
using Wants = std::vector<Want>;

[[noreturn]] void refuse(const Want& want, const std::string& why) {
  std::string path;
  for (const PathStep& step : *want.path) path += (path.empty() ? "" : ".") + path_step_text(step);
  throw std::invalid_argument(fmt::format("field '{}': {}", shown(path), why));
}

class PlanCompiler {
 public:
  PlanCompiler(const RosTypes& types, std::uint64_t most_alignment) : types_(types) {
    plan_.most_alignment = most_alignment;
    extents_.resize(types.types.size());
    passes_.resize(types.types.size());
  }

  MessagePlan compile(const MessageRequest& request) {
    Wants wants;
    const auto add = [&](const std::string& path, PlanTarget target) {
      paths_.push_back(std::make_unique<std::vector<PathStep>>(parse_message_path(path)));
      wants.push_back({paths_.back().get(), 0, target});
    };
    using Kind = PlanTarget::Kind;
    for (std::size_t i = 0; i < request.numbers.size(); ++i) add(request.numbers[i], {Kind::Number, i});
    for (std::size_t i = 0; i < request.text.size(); ++i) add(request.text[i], {Kind::Text, i});
    if (!request.time.empty()) add(request.time, {Kind::Time, 0});
    plan_.programs.emplace_back();
    plan_.programs[0] = program(0, wants, "");
    return std::move(plan_);
  }

 private:
  // Steps in the making: what has a fixed size gathers in `run` until something else follows.
  struct Emitter {
    std::vector<PlanStep> steps;
    PlanStep run;
    bool open = false;
    void append(const SizeByPlace& size) {
      open = true;
      for (std::size_t o = 0; o < 8; ++o)
        run.size[o] = std::min(kHugeSize, run.size[o] + size[(o + run.size[o]) % 8]);
    }
    void close() {
      if (open) steps.push_back(std::move(run));
      run = {};
      open = false;
    }
    PlanStep& add(PlanStep::Kind kind) {
      close();
      steps.emplace_back().kind = kind;
      return steps.back();
    }
  };
  // Arrays side by side in one message.
  struct SideBySide {
    std::map<std::string, std::size_t> tables;  // by the name of the array of names
    std::vector<PlanStep::Lookup> lookups;
    std::map<std::string, std::size_t> columns;  // by the name of the array of values
  };

  std::vector<PlanStep> program(std::size_t type, const Wants& wants, const std::string& prefix) {
    Emitter out;
    message(type, wants, prefix, out);
    out.close();
    return std::move(out.steps);
  }
  void message(std::size_t type, const Wants& wants, const std::string& prefix, Emitter& out);
  void field(const RosField& f, const Wants& wants, const std::string& prefix, SideBySide& side,
             Emitter& out);
  void scalar(const RosField& f, const Wants& wants, const std::string& prefix, Emitter& out);
  void values(const RosField& f, const Wants& wants, SideBySide& side, Emitter& out);
  void messages(const RosField& f, const Wants& wants, const std::string& prefix, Emitter& out);
  void pass_over(const RosField& f, Emitter& out);
  void find_side_by_side(const RosType& type, const Wants& wants, SideBySide& side);
  std::size_t group_program(const RosField& f, const Wants& wants, const std::string& path);
  void check_target(const RosField& f, const Want& want);
  [[noreturn]] void no_field(const Want& want, const std::string& prefix) const;

  SizeByPlace primitive_extent(RosPrimitive primitive) const {
    const std::uint64_t size = primitive_size(primitive);
    const std::uint64_t align = std::min(primitive == RosPrimitive::Time ? 4 : size, plan_.most_alignment);
    SizeByPlace extent;
    for (std::uint64_t o = 0; o < 8; ++o) extent[o] = (align - o % align) % align + size;
    return extent;
  }
  // Nothing where the size depends on the bytes.
  std::optional<SizeByPlace> element_extent(const RosField& f) {
    if (f.primitive == RosPrimitive::Message) return type_extent(f.type);
    if (f.primitive == RosPrimitive::String) return std::nullopt;
    return primitive_extent(f.primitive);
  }
  std::optional<SizeByPlace> field_extent(const RosField& f);
  std::optional<SizeByPlace> type_extent(std::size_t type);
  std::size_t pass_program(std::size_t type);  // passes over a whole message
  void refuse_in_xcdr2(const RosField& f) const {
    if (plan_.most_alignment == 4 && f.primitive >= RosPrimitive::String)
      throw BadDefinition("arrays of strings and messages are not read in XCDR2");
  }

  const RosTypes& types_;
  MessagePlan plan_;
  std::vector<std::unique_ptr<std::vector<PathStep>>> paths_;
  struct Extent {
    bool known = false;
    std::optional<SizeByPlace> size;
  };
  std::vector<Extent> extents_;                     // by type
  std::vector<std::optional<std::size_t>> passes_;  // by type
  bool in_group_ = false;
};

std::optional<SizeByPlace> PlanCompiler::field_extent(const RosField& f) {
  if (f.array == RosField::Array::Sequence) return std::nullopt;
  if (f.array == RosField::Array::None) return element_extent(f);
  refuse_in_xcdr2(f);
  if (f.length == 0) return SizeByPlace{};
  const auto one = element_extent(f);
  if (!one) return std::nullopt;
  SizeByPlace all;
  for (std::uint64_t o = 0; o < 8; ++o) all[o] = repeated_size(*one, o, f.length);
  return all;
}

std::optional<SizeByPlace> PlanCompiler::type_extent(std::size_t type) {
  if (extents_[type].known) return extents_[type].size;
  Emitter sum;
  bool fixed = true;
  for (const RosField& f : types_.types[type].fields) {
    const auto size = field_extent(f);
    if (!size) {
      fixed = false;
      break;
    }
    sum.append(*size);
  }
  extents_[type] = {true, fixed ? std::optional(sum.run.size) : std::nullopt};
  return extents_[type].size;
}

std::size_t PlanCompiler::pass_program(std::size_t type) {
  if (!passes_[type]) {
    passes_[type] = plan_.programs.size();
    plan_.programs.emplace_back();
    std::vector<PlanStep> steps = program(type, {}, "");
    plan_.programs[*passes_[type]] = std::move(steps);
  }
  return *passes_[type];
}

void PlanCompiler::no_field(const Want& want, const std::string& prefix) const {
  std::string path = prefix;
  for (std::size_t i = want.at; i < want.path->size(); ++i)
    path += (path.empty() ? "" : ".") + path_step_text((*want.path)[i]);
  std::vector<std::string> leaves = message_leaves(types_, kLeavesInMessages + 1);
  const std::string hint = did_you_mean(path, leaves);
  const bool more = leaves.size() > kLeavesInMessages;
  if (more) leaves.pop_back();
  throw std::invalid_argument(fmt::format(
      "no field '{}' in {}{}{} it has {}{}", shown(path), shown(types_.types[0].name), hint,
      hint.empty() ? ":" : "", printable(fmt::format("{}", fmt::join(leaves, ", "))), more ? ", ..." : ""));
}

void PlanCompiler::message(std::size_t type, const Wants& wants, const std::string& prefix, Emitter& out) {
  const RosType& t = types_.types[type];
  for (const Want& want : wants)
    if (t.find(want.step().name) == nullptr) no_field(want, prefix);
  SideBySide side;
  find_side_by_side(t, wants, side);
  for (const RosField& f : t.fields) {
    Wants here;
    for (const Want& want : wants)
      if (want.step().name == f.name) here.push_back(want);
    if (here.empty() && side.tables.count(f.name) == 0)
      pass_over(f, out);
    else
      field(f, here, prefix, side, out);
  }
  if (!side.lookups.empty()) out.add(PlanStep::Kind::Resolve).lookups = std::move(side.lookups);
}

// "position[name=left]" with names in an array of strings of the same message.
void PlanCompiler::find_side_by_side(const RosType& type, const Wants& wants, SideBySide& side) {
  for (const Want& want : wants) {
    const PathStep& step = want.step();
    const RosField& f = *type.find(step.name);
    if (step.selectors.empty() || f.primitive == RosPrimitive::Message) continue;
    const PathStep::Selector& selector = step.selectors.front();
    const RosField* names = type.find(selector.key);
    if (names == nullptr || names->primitive != RosPrimitive::String || names->array == RosField::Array::None)
      refuse(want, fmt::format("'{}' is no array of names beside it", shown(selector.key)));
    if (step.selectors.size() > 1) refuse(want, "expected one name");
    const auto [table, fresh] = side.tables.emplace(selector.key, plan_.keys.size());
    if (fresh) plan_.keys.emplace_back();
    auto& values = plan_.keys[table->second];
    auto value = std::find(values.begin(), values.end(), selector.value);
    if (value == values.end()) value = values.insert(values.end(), selector.value);
    const auto [column, first] = side.columns.emplace(f.name, plan_.columns);
    if (first) ++plan_.columns;
    check_target(f, want);
    side.lookups.push_back({table->second, static_cast<std::size_t>(value - values.begin()), column->second,
                            f.primitive, want.target});
  }
}

void PlanCompiler::check_target(const RosField& f, const Want& want) {
  if (!want.last()) refuse(want, fmt::format("'{}' has no fields", shown(f.name)));
  const bool text = f.primitive == RosPrimitive::String;
  if (text && want.target.kind != PlanTarget::Kind::Text && want.target.kind != PlanTarget::Kind::Key)
    refuse(want, "it is text, expected a number");
  if (!text && want.target.kind == PlanTarget::Kind::Text)
    refuse(want, fmt::format("it is a {}, expected text", primitive_name(f.primitive)));
  if (want.target.kind == PlanTarget::Kind::Time) plan_.time = f.primitive;
}

void PlanCompiler::field(const RosField& f, const Wants& wants, const std::string& prefix, SideBySide& side,
                         Emitter& out) {
  const bool array = f.array != RosField::Array::None;
  for (const Want& want : wants) {
    if (array == want.step().in_array()) continue;
    if (!array) refuse(want, fmt::format("'{}' is no array", shown(f.name)));
    refuse(want, fmt::format("'{0}' is an array: expected {0}[0] or {0}[name=...]", shown(f.name)));
  }
  if (!array) return scalar(f, wants, prefix, out);
  refuse_in_xcdr2(f);
  if (f.primitive == RosPrimitive::Message) return messages(f, wants, prefix, out);
  values(f, wants, side, out);
}

void PlanCompiler::scalar(const RosField& f, const Wants& wants, const std::string& prefix, Emitter& out) {
  if (f.primitive == RosPrimitive::Message) {
    Wants inside;
    for (const Want& want : wants) {
      if (want.last()) {
        std::vector<std::string> names;
        for (const RosField& part : types_.types[f.type].fields) names.push_back(part.name);
        refuse(want,
               fmt::format("it is a message with {}", printable(fmt::format("{}", fmt::join(names, ", ")))));
      }
      inside.push_back(want.deeper());
    }
    return message(f.type, inside, prefix + (prefix.empty() ? "" : ".") + f.name, out);
  }
  for (const Want& want : wants) check_target(f, want);
  if (f.primitive == RosPrimitive::String) {
    PlanStep& step = out.add(PlanStep::Kind::String);
    for (const Want& want : wants) step.picks.push_back({0, want.target});
    return;
  }
  out.append(primitive_extent(f.primitive));
  PlanStep::Read read{{}, f.primitive, {}};
  for (std::size_t o = 0; o < 8; ++o) read.offset[o] = out.run.size[o] - primitive_size(f.primitive);
  for (const Want& want : wants) {
    read.target = want.target;
    out.run.reads.push_back(read);
  }
}

void PlanCompiler::values(const RosField& f, const Wants& wants, SideBySide& side, Emitter& out) {
  const bool text = f.primitive == RosPrimitive::String;
  PlanStep& step = out.add(text ? PlanStep::Kind::Strings : PlanStep::Kind::Numbers);
  step.primitive = f.primitive;
  step.counted = f.array == RosField::Array::Sequence;
  step.length = f.length;
  if (const auto table = side.tables.find(f.name); table != side.tables.end()) step.keys = table->second;
  if (const auto column = side.columns.find(f.name); column != side.columns.end())
    step.column = column->second;
  for (const Want& want : wants) {
    if (!want.step().index) {
      if (text) refuse(want, "text is not looked up by name");
      continue;
    }
    check_target(f, want);
    step.picks.push_back({*want.step().index, want.target});
  }
}

void PlanCompiler::messages(const RosField& f, const Wants& wants, const std::string& prefix, Emitter& out) {
  std::map<std::string, Wants> by_element;
  for (const Want& want : wants) {
    if (want.last()) refuse(want, "its elements are messages: expected a field of theirs");
    by_element[path_step_text(want.step())].push_back(want);
  }
  PlanStep step;
  step.kind = PlanStep::Kind::Messages;
  step.counted = f.array == RosField::Array::Sequence;
  step.length = f.length;
  if (const auto size = type_extent(f.type)) {
    step.fixed = true;
    step.size = *size;
  } else {
    step.program = pass_program(f.type);
  }
  for (const auto& [text, same] : by_element) {
    const std::string path = prefix + (prefix.empty() ? "" : ".") + text;
    PlanStep::Element element;
    element.index = same.front().step().index;
    element.group = plan_.groups.size();
    if (element.index) {
      Wants inside;
      for (const Want& want : same) inside.push_back(want.deeper());
      element.program = plan_.programs.size();
      plan_.programs.emplace_back();
      std::vector<PlanStep> steps = program(f.type, inside, path);
      plan_.programs[element.program] = std::move(steps);
    } else {
      element.program = group_program(f, same, path);
    }
    step.elements.push_back(element);
  }
  out.close();
  out.steps.push_back(std::move(step));
}

// Reads an element with the fields that tell whether it is meant.
std::size_t PlanCompiler::group_program(const RosField& f, const Wants& wants, const std::string& path) {
  if (in_group_) refuse(wants.front(), "elements are selected inside of selected elements");
  in_group_ = true;
  MessagePlan::Group group;
  group.path = path;
  Wants inside;
  for (const PathStep::Selector& s : wants.front().step().selectors) {
    const char* end = s.value.data() + s.value.size();
    double number = 0;
    const auto [stop, error] = std::from_chars(s.value.data(), end, number);
    group.selectors.push_back({plan_.key_slots, s.value,
                               error == std::errc{} && stop == end ? std::optional(number) : std::nullopt});
    paths_.push_back(std::make_unique<std::vector<PathStep>>(parse_message_path(s.key)));
    inside.push_back({paths_.back().get(), 0, {PlanTarget::Kind::Key, plan_.key_slots++}});
  }
  for (const Want& want : wants) {
    group.targets.push_back(want.target);
    inside.push_back(want.deeper());
  }
  plan_.groups.push_back(std::move(group));
  const std::size_t place = plan_.programs.size();
  plan_.programs.emplace_back();
  std::vector<PlanStep> steps = program(f.type, inside, path);
  plan_.programs[place] = std::move(steps);
  in_group_ = false;
  return place;
}

void PlanCompiler::pass_over(const RosField& f, Emitter& out) {
  if (f.array != RosField::Array::None) refuse_in_xcdr2(f);
  if (const auto size = field_extent(f)) return out.append(*size);
  if (f.array == RosField::Array::None) {
    if (f.primitive == RosPrimitive::String)
      out.add(PlanStep::Kind::String);
    else
      out.add(PlanStep::Kind::Call).program = pass_program(f.type);
    return;
  }
  SideBySide none;
  field(f, {}, "", none, out);
}

}  // namespace

std::uint64_t repeated_size(const SizeByPlace& size, std::uint64_t place, std::uint64_t count) {
  // Where each begins modulo 8 soon repeats, and with it the sizes.
  std::uint64_t total = 0;
  const auto one = [&] {
    total += size[(place + total) % 8];
    --count;
  };
  for (int i = 0; i < 8 && count > 0; ++i) one();
  if (count == 0) return std::min(total, kHugeSize);
  const std::uint64_t begin = (place + total) % 8, before = total;
  std::uint64_t turn = 0;
  do {
    one();
    ++turn;
  } while (count > 0 && (place + total) % 8 != begin);
  const std::uint64_t bytes = total - before;
  if (bytes > 0 && count / turn > kHugeSize / bytes) return kHugeSize;
  total += count / turn * bytes;
  count %= turn;
  while (count > 0) one();
  return std::min(total, kHugeSize);
}

MessagePlan plan_message(const RosTypes& types, const MessageRequest& request, std::uint64_t most_alignment) {
  return PlanCompiler(types, most_alignment).compile(request);
}

}  // namespace odobench
