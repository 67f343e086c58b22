// What a config expects of a run's image, and whether the run has met it.
#pragma once

#include "engine/core/image.h"
#include "engine/core/knob.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace qtrace::experiments {

enum class Against { nothing, reference, mean };
enum class BlackImage { judged, unseen };

}  // namespace qtrace::experiments

template <>
struct qtrace::EnumNames<qtrace::experiments::Against> {
  static constexpr std::array<std::string_view, 3> values{"nothing", "reference", "mean"};
};
template <>
struct qtrace::EnumNames<qtrace::experiments::BlackImage> {
  static constexpr std::array<std::string_view, 2> values{"judged", "unseen"};
};

namespace qtrace::experiments {

struct Expectation {
  std::string note;
  Against against = Against::nothing;
  double mean = 0;
  double tolerance = 1e-4;
  BlackImage black = BlackImage::judged;
};

template <class Visitor>
void visit_knobs(Visitor& visit, Expectation& expect) {
  visit(KnobInfo{"note", "", "what is hard about the run, for who reads the verdict"}, expect.note);
  visit(KnobInfo{"against", "",
                 "what the last image must agree with, beyond chance: its reference, or the reference and a "
                 "known mean; samples that are not finite never agree"},
        expect.against);
  visit(KnobInfo{"mean", "radiance", "the known mean over pixels and channels", 0, 1e30}, expect.mean);
  visit(KnobInfo{"tolerance", "", "relative difference that is allowed besides that of chance", 0, 1},
        expect.tolerance);
  visit(KnobInfo{"black", "",
                 "an image without any light: judged as any other, or unseen, where the sampler cannot be "
                 "expected to find the light"},
        expect.black);
}

// Means are taken for normally distributed, which needs some hundred samples that meet light in every block.
// Standard errors that chance may explain: two estimates with normal errors differ by more in one of 1.7
// million comparisons.
constexpr double kMostDeviations = 5;
constexpr int kBlocks = 4;  // the image is compared as a whole, and in 4 x 4 blocks

struct Verdict {
  std::string word;       // "pass", "fail" or "unseen"
  std::string reason;     // of a failure
  double mean = 0;        // of the image, over pixels and channels
  double mean_error = 0;  // its standard error
  double expected = 0;    // the known mean, else that of the reference
  double worst_z = 0;     // largest difference beyond the tolerance, in standard errors
};

// `non_finite`: samples of the run. Nothing where nothing is expected.
std::optional<Verdict> judge(const Expectation& expect, const RadianceImage& image,
                             const RadianceImage& reference, std::uint64_t non_finite);

}  // namespace qtrace::experiments
