// Which images the parts and channels of an OpenEXR file make up, whoever wrote it: R, G, B or layer.R,
// layer.G, layer.B (Mitsuba, tev, Blender's ViewLayer.Combined.R), layer.red (Nuke), X, Y, Z, Y alone, Y with
// RY and BY.
#pragma once

#include <ImfMultiPartInputFile.h>

#include <string>
#include <vector>

namespace qtrace::experiments {

enum class LayerKind {
  rgb,               // linear Rec. 709
  xyz,               // CIE XYZ: X, Y, Z outside any layer, as Mitsuba writes them
  luminance,         // Y alone: grey
  luminance_chroma,  // Y, RY, BY; OpenEXR makes RGB of them
  vector,            // X, Y, Z of a layer: a normal, a position; compared as they stand
  value,             // any other single channel; compared as it stands, as grey
};

struct ExrLayer {
  int part = 0;
  std::string name;  // the layer's, or its part's where parts have names; kRootLayer for neither
  LayerKind kind = LayerKind::rgb;
  std::vector<std::string> channels;  // three, or the only one; the file's names
};

// Mitsuba's name for channels outside any layer.
constexpr const char* kRootLayer = "<root>";

struct LayerList {
  std::vector<ExrLayer> layers;       // in the order of the file
  std::vector<std::string> left_out;  // channels and parts that cannot be read, each with its reason
};

LayerList list_layers(const Imf::MultiPartInputFile& file);

// Those of this name, or else those whose name ends in it (Combined for ViewLayer.Combined).
std::vector<const ExrLayer*> layers_named(const LayerList& list, const std::string& name);

// The only layer of this name. Without a name: the channels outside any layer, else the only image in colour
// or grey, else the only one called combined, beauty, rgba, rgb or color. Throws Error that lists what is
// there.
const ExrLayer& choose_layer(const LayerList& list, const std::string& name);

}  // namespace qtrace::experiments
