#include "experiments/images/exr_layers.h"

#include "engine/core/check.h"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfPartType.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <map>
#include <optional>
#include <set>

namespace qtrace::experiments {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// What stands behind the last dot of a name.
std::string last_word(const std::string& name) { return name.substr(name.rfind('.') + 1); }

// What a channel is within its layer: "r" for layer.R and for layer.red.
std::string role_of(const std::string& channel) {
  const std::string word = lower(last_word(channel));
  if (word == "red" || word == "green" || word == "blue") return word.substr(0, 1);
  return word;
}

using Roles = std::map<std::string, std::string>;  // role -> the file's name

// The channels of one layer of a part, sorted by what can be done with them.
struct Group {
  Roles full;    // floats at full resolution
  Roles chroma;  // RY and BY, which may be subsampled
};

std::optional<std::vector<std::string>> pick(const Roles& roles, const std::vector<std::string>& wanted) {
  std::vector<std::string> channels;
  for (const std::string& role : wanted) {
    if (!roles.contains(role)) return std::nullopt;
    channels.push_back(roles.at(role));
  }
  return channels;
}

// Names differ between writers: a part's name, a layer's, or both in each channel.
std::string layer_name(const std::string& part, const std::string& prefix) {
  if (part.empty()) return prefix.empty() ? kRootLayer : prefix;
  if (prefix.empty() || prefix == part || prefix.starts_with(part + '.'))
    return prefix.empty() ? part : prefix;
  return part + '.' + prefix;
}

class PartReader {
 public:
  PartReader(int part, const Imf::Header& header, bool several, LayerList& list)
      : part_(part), name_(several && header.hasName() ? header.name() : ""), list_(list) {
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
      sort_in(channel.name(), channel.channel());
    }
    for (auto& [prefix, group] : groups_) add_layers(prefix, group);
  }

 private:
  void sort_in(const std::string& name, const Imf::Channel& channel) {
    const std::size_t dot = name.rfind('.');
    Group& group = groups_[dot == std::string::npos ? "" : name.substr(0, dot)];
    const std::string role = role_of(name);
    if (channel.type == Imf::UINT) {
      list_.left_out.push_back(fmt::format("{} (whole numbers)", name));
    } else if (role == "ry" || role == "by") {
      group.chroma[role] = name;
    } else if (channel.xSampling != 1 || channel.ySampling != 1) {
      list_.left_out.push_back(fmt::format("{} (subsampled)", name));
    } else if (!group.full.emplace(role, name).second) {
      list_.left_out.push_back(fmt::format("{} (a second {})", name, role));
    }
  }

  void add(const std::string& name, LayerKind kind, std::vector<std::string> channels) {
    list_.layers.push_back({part_, layer_name(name_, name), kind, std::move(channels)});
  }

  void add_layers(const std::string& prefix, Group& group) {
    std::set<std::string> used{"a"};  // opacity is not compared
    const auto take = [&](LayerKind kind, const std::vector<std::string>& roles) {
      auto channels = pick(group.full, roles);
      if (!channels) return false;
      used.insert(roles.begin(), roles.end());
      add(prefix, kind, std::move(*channels));
      return true;
    };
    const bool has_chroma = group.chroma.size() == 2;
    if (!take(LayerKind::rgb, {"r", "g", "b"}) &&
        !take(prefix.empty() ? LayerKind::xyz : LayerKind::vector, {"x", "y", "z"})) {
      take(has_chroma ? LayerKind::luminance_chroma : LayerKind::luminance, {"y"});
    }
    for (const auto& [role, name] : group.full) {
      if (!used.contains(role)) add(name, LayerKind::value, {name});
    }
  }

  int part_;
  std::string name_;
  LayerList& list_;
  std::map<std::string, Group> groups_;
};

using LayerTest = std::function<bool(const ExrLayer&)>;

std::vector<const ExrLayer*> matching(const LayerList& list, const LayerTest& test) {
  std::vector<const ExrLayer*> found;
  for (const ExrLayer& layer : list.layers) {
    if (test(layer)) found.push_back(&layer);
  }
  return found;
}

bool is_picture(const ExrLayer& layer) {
  return layer.kind != LayerKind::vector && layer.kind != LayerKind::value;
}

bool is_usual_name(const ExrLayer& layer) {
  static const std::set<std::string> usual{"combined", "beauty", "rgba", "rgb", "color"};
  return is_picture(layer) && usual.contains(lower(last_word(layer.name)));
}

std::string what_is_there(const LayerList& list) {
  std::string text;
  for (const ExrLayer& layer : list.layers) {
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", layer.name, fmt::join(layer.channels, ", "));
  }
  if (text.empty()) text = "none";
  if (!list.left_out.empty()) text += fmt::format("; not read: {}", fmt::join(list.left_out, ", "));
  return text;
}

}  // namespace

LayerList list_layers(const Imf::MultiPartInputFile& file) {
  LayerList list;
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::Header& header = file.header(part);
    if (header.hasType() && Imf::isDeepData(header.type())) {
      list.left_out.push_back(fmt::format("part {} (deep data)", header.hasName() ? header.name() : "1"));
    } else {
      PartReader(part, header, file.parts() > 1, list);
    }
  }
  return list;
}

std::vector<const ExrLayer*> layers_named(const LayerList& list, const std::string& name) {
  auto found = matching(list, [&](const ExrLayer& layer) { return layer.name == name; });
  if (!found.empty()) return found;
  return matching(list, [&](const ExrLayer& layer) { return layer.name.ends_with('.' + name); });
}

const ExrLayer& choose_layer(const LayerList& list, const std::string& name) {
  if (name.empty()) {
    for (const LayerTest& test :
         {LayerTest([](const ExrLayer& layer) { return is_picture(layer) && layer.name == kRootLayer; }),
          LayerTest(is_picture), LayerTest(is_usual_name)}) {
      const auto found = matching(list, test);
      if (found.size() == 1) return *found.front();
    }
    const bool any = !matching(list, is_picture).empty();
    fail("{}; its layers are: {}",
         any ? "has several images: name one" : "has no channels R, G, B, nor X, Y, Z or Y",
         what_is_there(list));
  }
  const auto found = layers_named(list, name);
  check(!found.empty(), "has no layer '{}'; its layers are: {}", name, what_is_there(list));
  check(found.size() == 1, "has several layers '{}'; its layers are: {}", name, what_is_there(list));
  return *found.front();
}

}  // namespace qtrace::experiments
