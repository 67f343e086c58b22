// What of a scene's file a picture shows, and from where.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace qtrace {

// One of several things in a file, by either; neither: whichever the file has first.
struct NameOrIndex {
  std::string name;
  std::optional<std::size_t> index;

  bool is_given() const { return index || !name.empty(); }
  std::string text() const { return index ? std::to_string(*index) : "'" + name + "'"; }
  bool operator==(const NameOrIndex&) const = default;
};

// In the file's own world. Of `up`, what is perpendicular to the viewing direction counts.
struct CameraPlace {
  std::array<double, 3> position{};
  std::array<double, 3> target{};
  std::array<double, 3> up{0, 1, 0};
  double vertical_fov = 40;  // degrees, in (0, 180)

  bool operator==(const CameraPlace&) const = default;
};

struct CameraChoice {
  enum class Kind {
    of_file,  // the camera `of_file`
    placed,   // at `place`
    fit,      // where all of the scene is in the picture
  };
  Kind kind = Kind::of_file;
  NameOrIndex of_file;
  CameraPlace place;

  bool operator==(const CameraChoice&) const = default;
};

struct View {
  NameOrIndex scene;  // of the file; not given: its default
  CameraChoice camera;
  double aspect = 1;  // width over height of the picture

  bool operator==(const View&) const = default;
};

}  // namespace qtrace
