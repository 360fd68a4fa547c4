#include "holdfast/io/config_io.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>
#include <variant>

#include "holdfast/io/yaml_block.hpp"

namespace holdfast::io {
namespace {

using Type = FieldRef::Type;
using Value = std::variant<bool, int, double, std::string, std::vector<double>, Eigen::Vector2d,
                           Eigen::Vector3d, SE3>;

constexpr std::uintmax_t kLargestFile = 1 << 20;

Error expected(std::string_view what, std::string_view found) {
  return {fmt::format("expected {}, found {}", what, found)};
}

/// What stands in the file, short enough for a message.
std::string describe(const YAML::Node& node) {
  constexpr std::size_t kLongest = 60;
  switch (node.Type()) {
    case YAML::NodeType::Scalar: {
      const std::string& text = node.Scalar();
      const bool is_long = text.size() > kLongest;
      return fmt::format("'{}{}'", text.substr(0, kLongest), is_long ? "..." : "");
    }
    case YAML::NodeType::Sequence: return fmt::format("a list of {} values", node.size());
    case YAML::NodeType::Map: return "a block of keys";
    default: return "nothing";
  }
}

bool is_quoted(const YAML::Node& node) { return node.Tag() == "!"; }

template <class T>
bool parse_whole(std::string_view text, T& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc() && result.ptr == end;
}

std::string range_text(std::string_view noun, const FieldDoc& doc) {
  const bool has_min = std::isfinite(doc.min);
  const bool has_max = std::isfinite(doc.max);
  if (has_min && has_max) return fmt::format("{} from {} to {}", noun, doc.min, doc.max);
  if (has_min) return fmt::format("{} >= {}", noun, doc.min);
  if (has_max) return fmt::format("{} <= {}", noun, doc.max);
  return std::string(noun);
}

Result<bool> read_bool(const YAML::Node& node) {
  const bool plain = node.IsScalar() && !is_quoted(node);
  if (plain && node.Scalar() == "true") return true;
  if (plain && node.Scalar() == "false") return false;
  return expected("true or false", describe(node));
}

template <class T>
Result<T> read_number(const YAML::Node& node, std::string_view noun, const FieldDoc& doc) {
  T value{};
  const bool parsed = node.IsScalar() && !is_quoted(node) && parse_whole(node.Scalar(), value);
  const auto real = static_cast<double>(value);
  if (!parsed || !std::isfinite(real) || real < doc.min || real > doc.max) {
    return expected(range_text(noun, doc), describe(node));
  }
  return value;
}

Result<std::string> read_string(const YAML::Node& node, const FieldDoc& doc) {
  if (!node.IsScalar()) return expected("text", describe(node));
  const std::string& text = node.Scalar();
  if (doc.choices.empty()) return text;
  std::string_view rest = doc.choices;
  while (true) {
    const auto bar = rest.find('|');
    if (rest.substr(0, bar) == text) return text;
    if (bar == std::string_view::npos) break;
    rest.remove_prefix(bar + 1);
  }
  return expected(fmt::format("one of {}", doc.choices), describe(node));
}

Result<std::vector<double>> read_doubles(const YAML::Node& node, const FieldDoc& doc) {
  if (!node.IsSequence()) return expected("a list of numbers", describe(node));
  std::vector<double> values;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const auto value = read_number<double>(node[i], "a finite number", doc);
    if (!value) return Error{fmt::format("value {}: {}", i + 1, value.error().message)};
    values.push_back(*value);
  }
  return values;
}

template <int kSize>
Result<Eigen::Matrix<double, kSize, 1>> read_vector(const YAML::Node& node, const FieldDoc& doc) {
  if (!node.IsSequence() || node.size() != kSize) {
    return expected(fmt::format("{} numbers", kSize), describe(node));
  }
  const auto values = read_doubles(node, doc);
  if (!values) return values.error();
  return Eigen::Matrix<double, kSize, 1>(values->data());
}

/// A quaternion of unit norm stays as it is, so that writing and reading keep the bits: a
/// normalised one has a squared norm within 4 epsilon of 1 (three roundings a component, four in
/// the sum).
std::optional<Eigen::Quaterniond> unit_quaternion(const Eigen::Vector4d& xyzw) {
  constexpr double kZeroNorm = 1e-9;
  const double unit_tolerance = 8 * std::numeric_limits<double>::epsilon();
  if (xyzw.cwiseAbs().maxCoeff() < kZeroNorm) return std::nullopt;
  if (std::abs(xyzw.squaredNorm() - 1.0) <= unit_tolerance) return Eigen::Quaterniond(xyzw);
  return Eigen::Quaterniond(Eigen::Vector4d(xyzw.stableNormalized()));
}

Result<SE3> read_pose(const YAML::Node& node) {
  constexpr std::string_view kWhat = "a pose [x, y, z, qx, qy, qz, qw]";
  if (!node.IsSequence() || node.size() != 7) return expected(kWhat, describe(node));
  const auto numbers = read_doubles(node, {});
  if (!numbers) return numbers.error();
  const auto& v = *numbers;
  const auto rotation = unit_quaternion({v[3], v[4], v[5], v[6]});
  if (!rotation) return expected("a quaternion that is not zero", "[qx, qy, qz, qw] = 0");
  return SE3{*rotation, {v[0], v[1], v[2]}};
}

template <class T>
Result<Value> widen(Result<T> result) {
  if (!result) return result.error();
  return Value(std::move(result).value());
}

Result<Value> read_value(const YAML::Node& node, const FieldRef& field) {
  switch (field.type) {
    case Type::kBool: return widen(read_bool(node));
    case Type::kInt: return widen(read_number<int>(node, "a whole number", field.doc));
    case Type::kDouble: return widen(read_number<double>(node, "a finite number", field.doc));
    case Type::kString: return widen(read_string(node, field.doc));
    case Type::kDoubles: return widen(read_doubles(node, field.doc));
    case Type::kVector2: return widen(read_vector<2>(node, field.doc));
    case Type::kVector3: return widen(read_vector<3>(node, field.doc));
    case Type::kPose: return widen(read_pose(node));
  }
  return Error{"a field of no known type"};
}

void store(Value value, const FieldRef& field) {
  const auto assign = [&](auto&& v) {
    using T = std::decay_t<decltype(v)>;
    *static_cast<T*>(field.value) = std::forward<decltype(v)>(v);
  };
  std::visit(assign, std::move(value));
  if (field.is_set != nullptr) *field.is_set = true;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row.back();
}

std::pair<std::string_view, std::string_view> split_key(std::string_view key) {
  const auto dot = key.find('.');
  if (dot == std::string_view::npos) return {{}, key};
  return {key.substr(0, dot), key.substr(dot + 1)};
}

/// The right key in a wrong module is nearer than another key of that module.
std::size_t key_distance(std::string_view a, std::string_view b) {
  constexpr std::size_t kMostForModule = 2;
  const auto [module_a, leaf_a] = split_key(a);
  const auto [module_b, leaf_b] = split_key(b);
  return edit_distance(leaf_a, leaf_b) +
         std::min(edit_distance(module_a, module_b), kMostForModule);
}

Error unknown_key(std::string_view key, const std::vector<FieldRef>& fields) {
  if (fields.empty()) return {fmt::format("unknown key '{}': no keys are known here", key)};
  const auto nearest =
      std::min_element(fields.begin(), fields.end(), [&](const FieldRef& a, const FieldRef& b) {
        return key_distance(key, a.key) < key_distance(key, b.key);
      });
  return {fmt::format("unknown key '{}': the nearest known key is '{}'", key, nearest->key)};
}

const FieldRef* find_field(std::string_view key, const std::vector<FieldRef>& fields) {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&](const FieldRef& field) { return field.key == key; });
  return found == fields.end() ? nullptr : &*found;
}

bool is_module(std::string_view name, const std::vector<FieldRef>& fields) {
  return std::any_of(fields.begin(), fields.end(), [&](const FieldRef& field) {
    return field.key.find('.') != std::string::npos && split_key(field.key).first == name;
  });
}

/// Walks one document and keeps what it read, so that an error changes nothing.
class DocumentReader {
 public:
  DocumentReader(std::string path, const std::vector<FieldRef>& fields)
      : path_(std::move(path)), fields_(fields) {}

  Status read(const YAML::Node& document) {
    if (document.IsNull()) return Done{};
    if (!document.IsMap()) return at(document, expected("keys with values", describe(document)));
    return read_block("", document);
  }

  void store_all() {
    for (auto& [field, value] : values_) store(std::move(value), *field);
  }

 private:
  Error at(const YAML::Node& node, const Error& error) const {
    return {fmt::format("{}:{}: {}", path_, node.Mark().line + 1, error.message)};
  }

  Status read_block(const std::string& prefix, const YAML::Node& block) {
    for (const auto& entry : block) {
      if (!entry.first.IsScalar()) return at(block, expected("a key", describe(entry.first)));
      const std::string key = prefix + entry.first.Scalar();
      if (!seen_.insert(key).second) {
        return at(entry.first, {fmt::format("key '{}' stands twice in this file", key)});
      }
      Status status = read_entry(key, entry.first, entry.second);
      if (!status) return status;
    }
    return Done{};
  }

  Status read_entry(const std::string& key, const YAML::Node& name, const YAML::Node& content) {
    if (const FieldRef* field = find_field(key, fields_)) {
      auto value = read_value(content, *field);
      if (!value) return at(name, {fmt::format("{}: {}", key, value.error().message)});
      values_.emplace_back(field, std::move(value).value());
      return Done{};
    }
    const bool at_top = key.find('.') == std::string::npos;
    if (at_top && content.IsMap() && content.size() > 0) return read_block(key + ".", content);
    if (!is_module(key, fields_)) return at(name, unknown_key(key, fields_));
    if (content.IsNull() || content.IsMap()) return Done{};
    return at(name,
              {fmt::format("{}: {}", key, expected("a block of keys", describe(content)).message)});
  }

  std::string path_;
  const std::vector<FieldRef>& fields_;
  std::set<std::string> seen_;
  std::vector<std::pair<const FieldRef*, Value>> values_;
};

Result<std::string> read_text(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) return Error{fmt::format("{}: cannot be read: {}", path.string(), error.message())};
  if (size > kLargestFile) {
    return Error{fmt::format("{}: expected a configuration of at most {} bytes, found {} bytes",
                             path.string(), kLargestFile, size)};
  }
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) return Error{fmt::format("{}: cannot be read", path.string())};
  return text.str();
}

Result<YAML::Node> parse_document(const std::string& path, const std::string& text) {
  try {
    const auto documents = YAML::LoadAll(text);
    if (documents.size() > 1) {
      return Error{fmt::format("{}: expected one YAML document, found {}", path, documents.size())};
    }
    return documents.empty() ? YAML::Node() : documents.front();
  } catch (const YAML::Exception& e) {
    return Error{fmt::format("{}:{}: expected YAML, found: {}", path, e.mark.line + 1, e.msg)};
  }
}

}  // namespace

Status read_config_file(const std::filesystem::path& path, std::vector<FieldRef>& fields) {
  const auto text = read_text(path);
  if (!text) return text.error();
  const auto document = parse_document(path.string(), *text);
  if (!document) return document.error();
  DocumentReader reader(path.string(), fields);
  try {
    Status status = reader.read(*document);
    if (!status) return status;
  } catch (const YAML::Exception& e) {
    return Error{fmt::format("{}:{}: {}", path.string(), e.mark.line + 1, e.msg)};
  }
  reader.store_all();
  return Done{};
}

Status read_block(const YAML::Node& block, const std::string& file, std::vector<FieldRef>& fields) {
  DocumentReader reader(file, fields);
  Status status = reader.read(block);
  if (status) reader.store_all();
  return status;
}

Result<YAML::Node> load_yaml(const std::filesystem::path& path) {
  const auto text = read_text(path);
  if (!text) return text.error();
  return parse_document(path.string(), *text);
}

Result<YAML::Node> parse_yaml(const std::string& text, const std::string& name) {
  return parse_document(name, text);
}

std::string describe_node(const YAML::Node& node) { return describe(node); }

Status set_field(const std::string& assignment, std::vector<FieldRef>& fields) {
  const std::string place = "--set " + assignment;
  const auto equals = assignment.find('=');
  if (equals == std::string::npos) {
    return Error{fmt::format("{}: {}", place, expected("module.key=value", "no '='").message)};
  }
  const std::string key = assignment.substr(0, equals);
  const FieldRef* field = find_field(key, fields);
  if (field == nullptr) {
    return Error{fmt::format("{}: {}", place, unknown_key(key, fields).message)};
  }
  const std::string text = assignment.substr(equals + 1);
  const bool is_list = field->type == Type::kDoubles || field->type == Type::kPose;
  const auto node = is_list ? parse_document(place, text) : Result<YAML::Node>(YAML::Node(text));
  if (!node) return node.error();
  auto value = read_value(*node, *field);
  if (!value) return Error{fmt::format("{}: {}", place, value.error().message)};
  store(std::move(value).value(), *field);
  return Done{};
}

Status check_required(const std::string& place, const std::vector<FieldRef>& fields) {
  std::string missing;
  for (const auto& field : fields) {
    if (field.is_set == nullptr || *field.is_set) continue;
    missing += fmt::format("{}'{}' ({})", missing.empty() ? "" : ", ", field.key, field.doc.text);
  }
  if (missing.empty()) return Done{};
  return Error{fmt::format("{}: missing, and there is no default: {}", place, missing)};
}

}  // namespace holdfast::io
