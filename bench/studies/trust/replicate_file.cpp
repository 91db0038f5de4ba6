#include "bench/studies/trust/replicate_file.hpp"

#include <utility>

#include "base/json_node.hpp"

namespace odobench {
namespace {

std::string line_of(std::size_t number, const Replicate& r) {
  return nlohmann::json{{"replicate", number},
                        {"recordings", r.resample},
                        {"cost", r.cost},
                        {"parameters", std::vector<double>(r.z.data(), r.z.data() + r.z.size())},
                        {"termination", r.termination}}
      .dump();
}

std::pair<std::size_t, Replicate> replicate_from(const JsonNode& node) {
  Replicate r;
  for (const std::int64_t n : node.at("recordings").integers()) {
    if (n < 0) node.at("recordings").fail("places from 0");
    r.resample.push_back(static_cast<std::size_t>(n));
  }
  r.cost = node.at("cost").number();
  const std::vector<double> z = node.at("parameters").numbers();
  r.z = Eigen::Map<const Vector>(z.data(), static_cast<Eigen::Index>(z.size()));
  r.termination = node.at("termination").text();
  return {static_cast<std::size_t>(node.at("replicate").count()), std::move(r)};
}

}  // namespace

ReplicateFile::ReplicateFile(std::filesystem::path file, nlohmann::json header)
    : path_(std::move(file)), header_(header.dump()) {
  require_own_folder(path_.parent_path());
  require_replaceable(path_);
  std::error_code error;
  if (std::filesystem::exists(path_, error)) read(read_file(path_));
}

void ReplicateFile::read(const std::string& text) {
  std::size_t begin = 0, number = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    if (++number == 1) {
      if (line != header_) return;
      continue;
    }
    try {
      auto [k, replicate] = replicate_from(JsonNode::parse_line(line, path_, number));
      in_order_ = in_order_ && k == known_.size();
      known_.insert_or_assign(k, std::move(replicate));
    } catch (const DataError& error) {
      damage_ = error.what();
      in_order_ = false;
      return;
    }
  }
}

std::string ReplicateFile::lines() const {
  std::string text = header_ + "\n";
  for (const auto& [number, replicate] : known_) text += line_of(number, replicate) + "\n";
  return text;
}

const Replicate* ReplicateFile::find(std::size_t number) const {
  const auto found = known_.find(number);
  return found == known_.end() ? nullptr : &found->second;
}

void ReplicateFile::add(std::size_t number, const Replicate& replicate) {
  if (!file_) {
    const std::string before = lines();
    file_ = std::make_unique<LineFile>(path_, Existing::Replace);
    file_->replace(before);
  }
  in_order_ = in_order_ && number == known_.size();
  known_.insert_or_assign(number, replicate);
  file_->append(line_of(number, replicate));
}

void ReplicateFile::finish() {
  if (file_ && !in_order_) file_->replace(lines());
}

}  // namespace odobench
