#include "datasets/logs/ros/messages/message_reader.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace odobench {
struct MessageReader::Impl {
  std::shared_ptr<const RosTypes> types;
  RosEncoding encoding;
  MessageRequest request;
  std::optional<MessagePlan> plans[2];  // [1]: XCDR2
  std::vector<bool> found_numbers;

  // The message at hand.
  const MessagePlan* plan = nullptr;
  MessageWire wire;
  struct Column {
    std::uint64_t begin = 0, count = 0;
  };
  struct Key {
    std::string_view text;
    double number = 0;
    bool is_text = false;
  };
  std::vector<std::vector<std::int64_t>> key_places;  // per table and name: its place, -1 where it is not
  std::vector<Column> columns;
  std::vector<Key> keys;
  std::vector<bool> group_found;
  MessageRow main, scratch;
  std::vector<MessageRow> rows;
  std::size_t row_count = 0;

  const MessagePlan& plan_for(std::uint64_t most_alignment) {
    auto& p = plans[most_alignment == 4 ? 1 : 0];
    if (!p) p = plan_message(*types, request, most_alignment);
    return *p;
  }
  void reset(MessageRow& row) const;
  void store(PlanTarget target, RosPrimitive primitive, const char* bytes, MessageRow& row);
  void store_text(PlanTarget target, std::string_view text, MessageRow& row);
  void run(std::size_t program, MessageRow& row);
  void run_numbers(const PlanStep& step, MessageRow& row);
  void run_strings(const PlanStep& step, MessageRow& row);
  void run_messages(const PlanStep& step, MessageRow& row);
  void run_lookups(const PlanStep& step, MessageRow& row);
  void take_if_selected(std::size_t group);
  void take(const MessagePlan::Group& group, const MessageRow& from, MessageRow& to);
  void read(std::string_view message);
};

void MessageReader::Impl::reset(MessageRow& row) const {
  row.numbers.assign(request.numbers.size(), std::numeric_limits<double>::quiet_NaN());
  row.text.assign(request.text.size(), {});
  row.present = 0;
  row.has_time = false;
}

void MessageReader::Impl::store(PlanTarget target, RosPrimitive primitive, const char* bytes,
                                MessageRow& row) {
  switch (target.kind) {
    case PlanTarget::Kind::Number:
      row.numbers[target.slot] = wire.value(primitive, bytes);
      ++row.present;
      return;
    case PlanTarget::Kind::Time:
      row.has_time = true;
      if (primitive == RosPrimitive::Float32 || primitive == RosPrimitive::Float64)
        row.time_real = wire.value(primitive, bytes);
      else
        row.time = wire.integer(primitive, bytes);
      return;
    case PlanTarget::Kind::Key:
      keys[target.slot] = {{}, wire.value(primitive, bytes), false};
      return;
    case PlanTarget::Kind::Text:
      return;
  }
}

void MessageReader::Impl::store_text(PlanTarget target, std::string_view text, MessageRow& row) {
  if (target.kind == PlanTarget::Kind::Key) {
    keys[target.slot] = {text, 0, true};
  } else {
    row.text[target.slot] = text;
    ++row.present;
  }
}

void MessageReader::Impl::run(std::size_t program, MessageRow& row) {
  for (const PlanStep& step : plan->programs[program]) {
    switch (step.kind) {
      case PlanStep::Kind::Fixed: {
        const std::size_t place = wire.at % 8;
        wire.need(step.size[place]);
        for (const PlanStep::Read& read : step.reads)
          store(read.target, read.primitive, wire.here() + read.offset[place], row);
        wire.at += step.size[place];
        break;
      }
      case PlanStep::Kind::String: {
        const std::string_view text = wire.string();
        for (const PlanStep::Pick& pick : step.picks) store_text(pick.target, text, row);
        break;
      }
      case PlanStep::Kind::Numbers:
        run_numbers(step, row);
        break;
      case PlanStep::Kind::Strings:
        run_strings(step, row);
        break;
      case PlanStep::Kind::Messages:
        run_messages(step, row);
        break;
      case PlanStep::Kind::Call:
        wire.count_elements(1);
        run(step.program, row);
        break;
      case PlanStep::Kind::Resolve:
        run_lookups(step, row);
        break;
    }
  }
}

void MessageReader::Impl::run_numbers(const PlanStep& step, MessageRow& row) {
  const std::uint64_t count = step.counted ? wire.length() : step.length;
  const std::uint64_t size = primitive_size(step.primitive);
  if (count > 0) wire.align(step.primitive == RosPrimitive::Time ? 4 : size);
  wire.need(count * size);
  for (const PlanStep::Pick& pick : step.picks)
    if (pick.index < count) store(pick.target, step.primitive, wire.here() + pick.index * size, row);
  if (step.column) columns[*step.column] = {wire.at, count};
  wire.at += count * size;
}

void MessageReader::Impl::run_strings(const PlanStep& step, MessageRow& row) {
  const std::uint64_t count = step.counted ? wire.length() : step.length;
  wire.count_elements(count);
  std::vector<std::int64_t>* places = nullptr;
  if (step.keys) {
    places = &key_places[*step.keys];
    std::fill(places->begin(), places->end(), -1);
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string_view text = wire.string();
    for (const PlanStep::Pick& pick : step.picks)
      if (pick.index == i) store_text(pick.target, text, row);
    if (places == nullptr) continue;
    const auto& names = plan->keys[*step.keys];
    for (std::size_t k = 0; k < names.size(); ++k)
      if ((*places)[k] < 0 && names[k] == text) (*places)[k] = static_cast<std::int64_t>(i);
  }
}

void MessageReader::Impl::run_messages(const PlanStep& step, MessageRow& row) {
  const std::uint64_t count = step.counted ? wire.length() : step.length;
  if (step.elements.empty() && step.fixed) {
    const std::uint64_t size = repeated_size(step.size, wire.at, count);
    wire.need(size);
    wire.at += size;
    return;
  }
  wire.count_elements(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t begin = wire.at;
    bool passed = false;
    for (const PlanStep::Element& element : step.elements) {
      if (element.index && *element.index != i) continue;
      wire.at = begin;
      passed = true;
      if (element.index) {
        run(element.program, row);
        continue;
      }
      reset(scratch);
      run(element.program, scratch);
      take_if_selected(element.group);
    }
    if (passed) continue;
    if (!step.fixed) {
      run(step.program, row);
      continue;
    }
    wire.need(step.size[wire.at % 8]);
    wire.at += step.size[wire.at % 8];
  }
}

void MessageReader::Impl::run_lookups(const PlanStep& step, MessageRow& row) {
  for (const PlanStep::Lookup& lookup : step.lookups) {
    const std::int64_t place = key_places[lookup.keys][lookup.value];
    if (place < 0) continue;
    if (lookup.target.kind == PlanTarget::Kind::Number) found_numbers[lookup.target.slot] = true;
    const Column& column = columns[lookup.column];
    const auto index = static_cast<std::uint64_t>(place);
    if (index < column.count)
      store(lookup.target, lookup.primitive,
            wire.begin() + column.begin + index * primitive_size(lookup.primitive), row);
  }
}

// The values of one element, which are in `scratch`.
void MessageReader::Impl::take_if_selected(std::size_t group) {
  const MessagePlan::Group& g = plan->groups[group];
  for (const MessagePlan::Group::Selector& selector : g.selectors) {
    const Key& key = keys[selector.key];
    if (key.is_text ? key.text != selector.text : !selector.number || key.number != *selector.number) return;
  }
  for (const PlanTarget& target : g.targets)
    if (target.kind == PlanTarget::Kind::Number) found_numbers[target.slot] = true;
  if (plan->groups.size() == 1) {
    if (row_count == rows.size()) rows.emplace_back();
    rows[row_count++] = scratch;
  } else if (!group_found[group]) {
    take(g, scratch, main);
    main.present += scratch.present;
  }
  group_found[group] = true;
}

void MessageReader::Impl::take(const MessagePlan::Group& group, const MessageRow& from, MessageRow& to) {
  for (const PlanTarget& target : group.targets) {
    if (target.kind == PlanTarget::Kind::Number) to.numbers[target.slot] = from.numbers[target.slot];
    if (target.kind == PlanTarget::Kind::Text) to.text[target.slot] = from.text[target.slot];
    if (target.kind != PlanTarget::Kind::Time) continue;
    to.has_time = from.has_time;
    to.time = from.time;
    to.time_real = from.time_real;
  }
}

void MessageReader::Impl::read(std::string_view message) {
  wire = MessageWire(encoding, message);
  plan = &plan_for(wire.most_alignment());
  row_count = 0;
  key_places.resize(plan->keys.size());
  for (std::size_t t = 0; t < key_places.size(); ++t) key_places[t].assign(plan->keys[t].size(), -1);
  columns.assign(plan->columns, {});
  keys.assign(plan->key_slots, {});
  group_found.assign(plan->groups.size(), false);
  reset(main);
  run(0, main);
  wire.require_end();
  // What stands outside of the selected elements belongs to each of their rows.
  for (std::size_t i = 0; i < row_count; ++i) {
    MessageRow merged = main;
    take(plan->groups[0], rows[i], merged);
    merged.present += rows[i].present;
    rows[i] = std::move(merged);
  }
}

MessageReader::MessageReader(std::shared_ptr<const RosTypes> types, RosEncoding encoding,
                             MessageRequest request)
    : impl_(std::make_unique<Impl>()) {
  impl_->types = std::move(types);
  impl_->encoding = encoding;
  impl_->request = std::move(request);
  if (impl_->request.time.empty()) impl_->request.time = default_time_path(*impl_->types, impl_->request);
  impl_->found_numbers.assign(impl_->request.numbers.size(), false);
  impl_->plan_for(encoding == RosEncoding::Cdr ? 8 : 1);
}

MessageReader::~MessageReader() = default;

MessageReader::Rows MessageReader::read(std::string_view message) {
  impl_->read(message);
  if (impl_->plan->groups.size() == 1) return {impl_->rows.data(), impl_->row_count};
  return {&impl_->main, 1};
}

bool MessageReader::has_time_path() const {
  return !impl_->request.time.empty();
}
RosPrimitive MessageReader::time_primitive() const {
  return impl_->plans[0]->time;
}
const std::vector<bool>& MessageReader::found() const {
  return impl_->found_numbers;
}

}  // namespace odobench
