#include "experiments/measure/ldr_flip.h"

#include "experiments/images/colour.h"
#include "experiments/images/convolution.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace qtrace::experiments {
namespace {

// Section numbers are the paper's.
constexpr double kColourExponent = 0.7;   // q_c, 4.1.4
constexpr double kKneeAt = 0.4;           // p_c: this share of the largest colour difference ...
constexpr double kKneeValue = 0.95;       // p_t: ... becomes this error, 4.1.4
constexpr double kFeatureExponent = 0.5;  // q_f, 4.2.2
constexpr double kFeatureWidth = 0.082;   // degrees: of the eye's edge detector, 4.2.1
const glm::dvec3 kWhite = kRec709ToXyz * glm::dvec3(1.0);
const glm::dmat3 kXyzToRec709 = glm::inverse(kRec709ToXyz);

// A term a sqrt(pi / b) exp(-pi^2 d^2 / b), d in degrees, of a contrast sensitivity function (table 1).
struct Sensitivity {
  double a;
  double b;
  double height() const { return a * std::sqrt(std::numbers::pi / b); }
  double sigma() const { return std::sqrt(b / 2) / std::numbers::pi * kPixelsPerDegree; }  // pixels
};
constexpr Sensitivity kAchromatic{1, 0.0047};
constexpr Sensitivity kRedGreen{1, 0.0053};
constexpr Sensitivity kBlueYellow[2]{{34.1, 0.04}, {13.5, 0.025}};

// The widest term decides for all: three standard deviations.
int filter_radius() { return static_cast<int>(std::ceil(3 * kBlueYellow[0].sigma())); }

Plane seen(const Plane& plane, const Sensitivity& term) {
  const Kernel kernel = gaussian(term.sigma(), filter_radius());
  return convolve(plane, kernel, kernel);
}

// The sum of both terms as one kernel of sum one: each normalised by itself, mixed by what it sums to.
Plane seen_blue_yellow(const Plane& plane) {
  double volume[2];
  for (int i = 0; i < 2; ++i) {
    double sum = 0;
    const double sigma = kBlueYellow[i].sigma();
    for (int x = -filter_radius(); x <= filter_radius(); ++x) sum += std::exp(-x * x / (2 * sigma * sigma));
    volume[i] = kBlueYellow[i].height() * sum * sum;
  }
  Plane result = seen(plane, kBlueYellow[0]);
  const Plane second = seen(plane, kBlueYellow[1]);
  const double share = volume[0] / (volume[0] + volume[1]);
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    result.values[i] = share * result.values[i] + (1 - share) * second.values[i];
  }
  return result;
}

// An image as YCxCz without the constants of scale and offset, which drop out: all filters are linear and sum
// to one, or to zero for features.
struct Opponent {
  Plane y, cx, cz;  // Y, X - Y and Y - Z, each relative to white
};

Opponent opponent(const DisplayImage& image) {
  Opponent planes{
      {image.width, image.height, {}}, {image.width, image.height, {}}, {image.width, image.height, {}}};
  for (Plane* plane : {&planes.y, &planes.cx, &planes.cz}) plane->values.reserve(image.pixels.size());
  for (const glm::dvec3& rgb : image.pixels) {
    const glm::dvec3 xyz = kRec709ToXyz * rgb / kWhite;
    planes.y.values.push_back(xyz.y);
    planes.cx.values.push_back(xyz.x - xyz.y);
    planes.cz.values.push_back(xyz.y - xyz.z);
  }
  return planes;
}

double lab_curve(double t) {
  constexpr double kDelta = 6.0 / 29;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
}

// L*a*b* of linear RGB with Hunt's adjustment: chroma counts by lightness (4.1.3).
glm::dvec3 hunt_lab(const glm::dvec3& rgb) {
  const glm::dvec3 xyz = kRec709ToXyz * rgb / kWhite;
  const double x = lab_curve(xyz.x), y = lab_curve(xyz.y), z = lab_curve(xyz.z);
  const double lightness = 116 * y - 16;
  return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

// HyAB: city block in lightness, Euclidean in chroma (4.1.4).
double hyab(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 d = a - b;
  return std::abs(d.x) + std::hypot(d.y, d.z);
}

double colour_error(const glm::dvec3& a, const glm::dvec3& b) {
  static const double largest =
      std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kColourExponent);  // green against blue
  const double difference = std::pow(hyab(a, b), kColourExponent);
  const double knee = kKneeAt * largest;
  if (difference < knee) return kKneeValue * difference / knee;
  return kKneeValue + (1 - kKneeValue) * (difference - knee) / (largest - knee);
}

// What the eye's contrast sensitivity leaves, as adjusted L*a*b*.
std::vector<glm::dvec3> perceived_colours(const Opponent& planes) {
  const Plane y = seen(planes.y, kAchromatic);
  const Plane cx = seen(planes.cx, kRedGreen);
  const Plane cz = seen_blue_yellow(planes.cz);
  std::vector<glm::dvec3> colours;
  colours.reserve(y.values.size());
  for (std::size_t i = 0; i < y.values.size(); ++i) {
    const glm::dvec3 xyz{y.values[i] + cx.values[i], y.values[i], y.values[i] - cz.values[i]};
    colours.push_back(hunt_lab(glm::clamp(kXyzToRec709 * (xyz * kWhite), 0.0, 1.0)));
  }
  return colours;
}

// Lengths of the gradient (edges) and of the second derivatives (points) of the luminance.
struct Features {
  std::vector<double> edges, points;
};

std::vector<double> lengths(const Plane& x, const Plane& y) {
  std::vector<double> result;
  for (std::size_t i = 0; i < x.values.size(); ++i) result.push_back(std::hypot(x.values[i], y.values[i]));
  return result;
}

Features features(const Plane& luminance) {
  const double sigma = 0.5 * kFeatureWidth * kPixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const Kernel smooth = gaussian(sigma, radius);
  Kernel first, second;
  for (int x = -radius; x <= radius; ++x) {
    const double g = smooth[static_cast<std::size_t>(x + radius)];
    first.push_back(-x * g);
    second.push_back((x * x / (sigma * sigma) - 1) * g);
  }
  first = balanced(std::move(first));
  second = balanced(std::move(second));
  return {lengths(convolve(luminance, first, smooth), convolve(luminance, smooth, first)),
          lengths(convolve(luminance, second, smooth), convolve(luminance, smooth, second))};
}

}  // namespace

std::vector<double> ldr_flip(const DisplayImage& a, const DisplayImage& b) {
  const Opponent opponent_a = opponent(a), opponent_b = opponent(b);
  const std::vector<glm::dvec3> colours_a = perceived_colours(opponent_a);
  const std::vector<glm::dvec3> colours_b = perceived_colours(opponent_b);
  const Features features_a = features(opponent_a.y), features_b = features(opponent_b.y);
  std::vector<double> errors;
  errors.reserve(a.pixels.size());
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const double feature = std::max(std::abs(features_a.edges[i] - features_b.edges[i]),
                                    std::abs(features_a.points[i] - features_b.points[i]));
    const double feature_error = std::pow(feature / std::numbers::sqrt2, kFeatureExponent);
    errors.push_back(std::pow(colour_error(colours_a[i], colours_b[i]), 1 - feature_error));
  }
  return errors;
}

}  // namespace qtrace::experiments
