#include "engine/gltf_document/schema.h"

#include "engine/gltf_document/rules.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <string>

namespace qtrace::gltf {
namespace {

using nlohmann::json;

// Words of digits stand for integers, others for strings.
bool is_one_of(std::string_view words, const json& value) {
  const bool are_integers = words.front() >= '0' && words.front() <= '9';
  if (!are_integers && !value.is_string()) return false;
  const std::string spelling = are_integers ? value.dump() : value.get<std::string>();
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    if (words.substr(0, end) == spelling) return true;
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return false;
}

std::string found(const json& value) {
  return value.is_structured() ? fmt::format("an {}", value.type_name()) : shortened(value.dump(), 60);
}

bool fits_float(const json& value) {
  return value.is_number() && std::abs(value.get<double>()) <= std::numeric_limits<float>::max();
}

void check_index(const Source& source, const json& document, const json& value, const std::string& where,
                 std::string_view target) {
  const json::json_pointer array("/" + std::string(target));
  const std::size_t count =
      document.contains(array) && document.at(array).is_array() ? document.at(array).size() : 0;
  source.check(value.is_number_unsigned() && value.get<std::uint64_t>() < count,
               "{} is {}; an index below {}, the number of {}, would be right", where, found(value), count,
               target.substr(target.rfind('/') + 1));
}

void check_numbers(const Source& source, json& value, const std::string& where, std::size_t length) {
  source.check(value.is_array() && value.size() == length, "{} is {}; an array of {} numbers would be right",
               where, found(value), length);
  for (json& number : value) {
    source.check(fits_float(number), "{} holds {}; finite numbers within float's range would be right", where,
                 found(number));
    number = number.get<double>();
  }
}

void check_stride(const Source& source, const json& value, const std::string& where) {
  const bool is_valid =
      value.is_number_unsigned() && value >= 4U && value <= 252U && value.get<std::uint64_t>() % 4 == 0;
  source.check(is_valid, "{} is {}; a multiple of 4 from 4 to 252 would be right", where, found(value));
}

void check_leaf(const Source& source, const json& document, json& value, const std::string& where,
                const Rule& rule) {
  const auto expect = [&](bool condition, std::string_view right) {
    if (!condition) source.fail("{} is {}; {} would be right", where, found(value), right);
  };
  switch (rule.kind) {
    case Kind::string:
      return expect(value.is_string(), "a string");
    case Kind::boolean:
      return expect(value.is_boolean(), "true or false");
    case Kind::integer:
      return expect(value.is_number_unsigned(), "an integer of 0 or more");
    case Kind::stride:
      return check_stride(source, value, where);
    case Kind::numbers:
      return check_numbers(source, value, where, rule.length);
    case Kind::one_of:
      return expect(is_one_of(rule.words, value), fmt::format("one of {}", rule.words));
    case Kind::index:
      return check_index(source, document, value, where, rule.words);
    case Kind::number:
      expect(fits_float(value), "a finite number within float's range");
      value = value.get<double>();
  }
}

// Walks `path` from `value`; recursion is as deep as a path is long.
void visit(const Source& source, const json& document, json& value, std::string_view path,
           const std::string& where, const Rule& rule) {
  if (path.empty()) return check_leaf(source, document, value, where, rule);
  const std::size_t end = std::min(path.find('/'), path.size());
  std::string_view name = path.substr(0, end);
  const std::string_view rest = path.substr(std::min(end + 1, path.size()));
  if (name == "[]") {
    source.check(value.is_array(), "{} is {}; an array would be right", where, found(value));
    for (std::size_t i = 0; i < value.size(); ++i) {
      visit(source, document, value[i], rest, fmt::format("{}[{}]", where, i), rule);
    }
    return;
  }
  source.check(value.is_object(), "{} is {}; an object would be right", where, found(value));
  const auto enter = [&](const std::string& key, json& member) {
    visit(source, document, member, rest, where.empty() ? key : where + "." + key, rule);
  };
  if (name == "{}") {
    for (const auto& [key, member] : value.items()) enter(key, member);
    return;
  }
  const bool required = name.ends_with('!');
  if (required) name.remove_suffix(1);
  const auto member = value.find(name);
  source.check(member != value.end() || !required, "{}.{} is missing", where, name);
  if (member != value.end()) enter(std::string(name), *member);
}

// The indices of textures that materials use, and of the images and samplers of these.
struct UsedParts {
  std::set<std::size_t> textures;
  std::set<std::size_t> images;
  std::set<std::size_t> samplers;
};

void add_index(const json& object, const char* name, std::set<std::size_t>& indices) {
  if (!object.is_object()) return;
  const auto found = object.find(name);
  if (found != object.end() && found->is_number_unsigned()) indices.insert(found->get<std::size_t>());
}

// Of anything called ...Texture, at any depth: extensions have some, too. As deep as parse_json() lets files
// nest.
void add_textures(const json& value, std::set<std::size_t>& textures) {
  if (!value.is_structured()) return;
  for (const auto& [key, member] : value.items()) {
    if (value.is_object() && key.ends_with("Texture")) add_index(member, "index", textures);
    add_textures(member, textures);
  }
}

UsedParts used_parts(const json& document) {
  UsedParts used;
  const auto materials = document.find("materials");
  if (materials != document.end()) add_textures(*materials, used.textures);
  const auto textures = document.find("textures");
  if (textures == document.end() || !textures->is_array()) return used;
  for (const std::size_t i : used.textures) {
    if (i >= textures->size()) continue;
    add_index((*textures)[i], "source", used.images);
    add_index((*textures)[i], "sampler", used.samplers);
  }
  return used;
}

// A rule for the elements of an array of which some, or all, may be used by nothing.
void visit_unused(Source& source, json& document, const Rule& rule, std::string_view array,
                  const std::set<std::size_t>& used) {
  const auto found = document.find(array);
  if (found == document.end() || !found->is_array()) {
    return visit(source, document, document, rule.path, "", rule);
  }
  const std::string_view rest = rule.path.substr(array.size() + std::string_view("/[]/").size());
  for (std::size_t i = 0; i < found->size(); ++i) {
    const std::string where = fmt::format("{}[{}]", array, i);
    if (used.contains(i)) {
      visit(source, document, (*found)[i], rest, where, rule);
      continue;
    }
    try {
      visit(source, document, (*found)[i], rest, where, rule);
    } catch (const Error& error) {
      const std::string message = error.what();
      source.warn("{}; it is left out, as nothing uses it", message.substr(source.file.size() + 2));
    }
  }
}

void visit_rule(Source& source, json& document, const Rule& rule, const UsedParts& used) {
  if (rule.path.starts_with("textures/"))
    return visit_unused(source, document, rule, "textures", used.textures);
  if (rule.path.starts_with("images/")) return visit_unused(source, document, rule, "images", used.images);
  if (rule.path.starts_with("samplers/"))
    return visit_unused(source, document, rule, "samplers", used.samplers);
  if (rule.path.starts_with("animations/")) return visit_unused(source, document, rule, "animations", {});
  visit(source, document, document, rule.path, "", rule);
}

// tinygltf would drop the three without a word.
void check_transform(const Source& source, const json& node, std::size_t index) {
  const bool has_parts = node.contains("translation") || node.contains("rotation") || node.contains("scale");
  source.check(!node.contains("matrix") || !has_parts,
               "nodes[{}] has a matrix beside translation, rotation or scale; one of both would be right",
               index);
}

// The numbers of a camera stand in an object that is called as its type is.
void check_camera(const Source& source, const json& camera, std::size_t index) {
  const auto type = camera.at("type").get<std::string>();
  source.check(camera.contains(type), "cameras[{}].{} is missing", index, type);
}

// The same of a light that is a spot. A range of 0 would be tinygltf's word for none.
void check_light(const Source& source, const json& light, std::size_t index) {
  const std::string place = label("light", index, light.value("name", ""));
  source.check(light.at("type") != "spot" || light.contains("spot"),
               "{} is a spot and has no member spot; an object would be right", place);
  source.check(!light.contains("range") || light["range"] > 0,
               "{}: range is {}; a number above 0 would be right", place, light.value("range", 0.0));
}

void check_textures(const Source& source, json& document) {
  for (const std::string_view place : kTexturePlaces) {
    for (const Rule& rule : kTextureRules) {
      const std::string path = fmt::format("{}/{}", place, rule.path);
      visit(source, document, document, path, "", rule);
    }
  }
}

}  // namespace

void check_json(Source& source, json& document) {
  const UsedParts used = used_parts(document);
  for (const Rule& rule : kRules) visit_rule(source, document, rule, used);
  check_textures(source, document);
  const auto nodes = document.find("nodes");
  for (std::size_t i = 0; nodes != document.end() && i < nodes->size(); ++i) {
    check_transform(source, (*nodes)[i], i);
  }
  const auto cameras = document.find("cameras");
  for (std::size_t i = 0; cameras != document.end() && i < cameras->size(); ++i) {
    check_camera(source, (*cameras)[i], i);
  }
  const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
  if (!document.contains(lights)) return;
  for (std::size_t i = 0; i < document[lights].size(); ++i) check_light(source, document[lights][i], i);
}

}  // namespace qtrace::gltf
