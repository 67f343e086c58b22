// OpenEXR files as other programs name their channels: which are read, and which are refused with what words.
#include "experiments/images/exr_picture.h"
#include "engine/core/check.h"
#include "tests/support/exr_files.h"
#include "tests/system/temp_folder.h"

#include <ImfRgbaFile.h>

#include <gtest/gtest.h>

namespace qtrace::experiments {
namespace {

using tests::TestChannel;
using tests::TestPart;

class ExrPicture : public testing::Test {
 protected:
  // The channels of a 3x2 image.
  std::filesystem::path write(const std::vector<TestChannel>& channels) const {
    tests::write_scan_lines(file_, {channels, "", {{0, 0}, {2, 1}}, {{0, 0}, {2, 1}}});
    return file_;
  }

  std::string refusal(const std::string& layer = "") const {
    try {
      read_picture(file_, layer);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  static void expect_pixels(const Picture& picture, const glm::dvec3& first) {
    ASSERT_EQ(picture.image.width, 3);
    ASSERT_EQ(picture.image.height, 2);
    EXPECT_EQ(picture.image.mean[0], first);
    EXPECT_EQ(picture.image.mean[5], first + glm::dvec3(120.0));  // pixel (2, 1): 10 * 2 + 100 * 1 more
  }

  static bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }

  tests::TempFolder folder_;
  std::filesystem::path file_ = folder_ / "image.exr";
};

TEST_F(ExrPicture, NamesOfColour) {
  const std::vector<std::vector<std::string>> ways{
      {"R", "G", "B"},
      {"color.R", "color.G", "color.B"},
      {"combined.R", "combined.G", "combined.B"},
      {"<root>.R", "<root>.G", "<root>.B"},
      {"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B"},
      {"diffuse.red", "diffuse.green", "diffuse.blue"},
      {"r", "g", "b"},
  };
  for (const auto& names : ways) {
    const Picture picture = read_picture(write({{names[0], 1}, {names[1], 2}, {names[2], 3}}));
    expect_pixels(picture, {1, 2, 3});
    EXPECT_EQ(picture.channels, names[0] + ", " + names[1] + ", " + names[2]);
    EXPECT_EQ(picture.image.samples, 0U);
  }
}

TEST_F(ExrPicture, OpacityDepthAndNormalsStandAside) {
  write({{"R", 1},
         {"G", 2},
         {"B", 3},
         {"A", 9},
         {"Z", 8},
         {"normal.X", 7},
         {"normal.Y", 6},
         {"normal.Z", 5},
         {"albedo.R", 0.5},
         {"albedo.G", 0.5},
         {"albedo.B", 0.5}});
  expect_pixels(read_picture(file_), {1, 2, 3});
  expect_pixels(read_picture(file_, "albedo"), {0.5, 0.5, 0.5});
  const Picture normal = read_picture(file_, "normal");
  expect_pixels(normal, {7, 6, 5});  // components, no colour
  EXPECT_EQ(normal.channels, "normal.X, normal.Y, normal.Z (as they stand)");
  expect_pixels(read_picture(file_, "Z"), {8, 8, 8});
  expect_pixels(read_picture(file_, "<root>"), {1, 2, 3});
}

TEST_F(ExrPicture, TheCombinedPassIsTheMainOne) {
  write({{"ViewLayer.Combined.R", 1},
         {"ViewLayer.Combined.G", 2},
         {"ViewLayer.Combined.B", 3},
         {"ViewLayer.Combined.A", 1},
         {"ViewLayer.DiffCol.R", 4},
         {"ViewLayer.DiffCol.G", 5},
         {"ViewLayer.DiffCol.B", 6},
         {"ViewLayer.Depth.Z", 7}});
  expect_pixels(read_picture(file_), {1, 2, 3});
  expect_pixels(read_picture(file_, "ViewLayer.DiffCol"), {4, 5, 6});
  expect_pixels(read_picture(file_, "DiffCol"), {4, 5, 6});
  const std::string missing = refusal("Emit");
  EXPECT_TRUE(contains(missing, "image.exr: has no layer 'Emit'; its layers are: ViewLayer.Combined ("))
      << missing;
  EXPECT_TRUE(contains(missing, "ViewLayer.Depth.Z (ViewLayer.Depth.Z)")) << missing;
}

TEST_F(ExrPicture, SeveralThatFitAreListed) {
  write({{"left.R", 1}, {"left.G", 2}, {"left.B", 3}, {"right.R", 4}, {"right.G", 5}, {"right.B", 6}});
  EXPECT_TRUE(contains(refusal(),
                       "image.exr: has several images: name one; its layers are: left (left.R, left.G, "
                       "left.B), right (right.R, right.G, right.B)"))
      << refusal();
  expect_pixels(read_picture(file_, "right"), {4, 5, 6});
  write({{"a.x.R", 1}, {"a.x.G", 2}, {"a.x.B", 3}, {"b.x.R", 4}, {"b.x.G", 5}, {"b.x.B", 6}});
  EXPECT_TRUE(contains(refusal("x"), "has several layers 'x'"));
}

TEST_F(ExrPicture, HalfFloats) {
  expect_pixels(read_picture(write({{"R", 1, Imf::HALF}, {"G", 2, Imf::HALF}, {"B", 0.5, Imf::HALF}})),
                {1, 2, 0.5});
}

TEST_F(ExrPicture, WholeNumbersAreNoRadiance) {
  write({{"R", 1, Imf::UINT}, {"G", 2, Imf::UINT}, {"B", 3, Imf::UINT}});
  EXPECT_TRUE(contains(refusal(),
                       "image.exr: has no channels R, G, B, nor X, Y, Z or Y; its layers are: none; not "
                       "read: B (whole numbers), G (whole numbers), R (whole numbers)"))
      << refusal();
  expect_pixels(read_picture(write({{"R", 1}, {"G", 2}, {"B", 3}, {"id", 4, Imf::UINT}})), {1, 2, 3});
}

TEST_F(ExrPicture, LuminanceAloneIsGrey) {
  const Picture picture = read_picture(write({{"Y", 4}}));
  expect_pixels(picture, {4, 4, 4});
  EXPECT_EQ(picture.channels, "Y (as grey)");
  expect_pixels(read_picture(write({{"mono.Y", 3}})), {3, 3, 3});
}

// White (0.9504285, 1, 1.0889004) of any strength is R = G = B; published to seven digits.
TEST_F(ExrPicture, TristimulusValuesBecomeRec709) {
  tests::write_scan_lines(
      file_, {{{"X", 0.9504285}, {"Y", 1}, {"Z", 1.0889004}}, "", {{0, 0}, {0, 0}}, {{0, 0}, {0, 0}}});
  const Picture white = read_picture(file_);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(white.image.mean[0][c], 1, 1e-6);
  // IEC 61966-2-1's inverse matrix, first column: one unit of X.
  tests::write_scan_lines(file_, {{{"X", 1}, {"Y", 0}, {"Z", 0}}, "", {{0, 0}, {0, 0}}, {{0, 0}, {0, 0}}});
  const glm::dvec3 x = read_picture(file_).image.mean[0];
  EXPECT_NEAR(x.r, 3.2406, 1e-3);
  EXPECT_NEAR(x.g, -0.9689, 1e-3);
  EXPECT_NEAR(x.b, 0.0557, 1e-3);
}

Imf::Chromaticities rec2020() {
  return {{0.708F, 0.292F}, {0.170F, 0.797F}, {0.131F, 0.046F}, {0.3127F, 0.3290F}};
}

// ITU-R BT.2087-0, M2, has the matrix to four digits: what one unit of each primary is in Rec. 709.
TEST_F(ExrPicture, OtherPrimariesBecomeRec709) {
  const Imath::Box2i pixel{{0, 0}, {0, 0}};
  const std::vector<std::pair<glm::dvec3, glm::dvec3>> known{{{1, 0, 0}, {1.6605, -0.1246, -0.0182}},
                                                             {{0, 1, 0}, {-0.5876, 1.1329, -0.1006}},
                                                             {{0, 0, 1}, {-0.0728, -0.0083, 1.1187}},
                                                             {{2, 2, 2}, {2, 2, 2}}};
  for (const auto& [rgb, rec709] : known) {
    tests::write_scan_lines(
        file_,
        {{{"R", rgb.r}, {"G", rgb.g}, {"B", rgb.b}, {"variance.R", 1}, {"variance.G", 1}, {"variance.B", 1}},
         "",
         pixel,
         pixel,
         rec2020()});
    const Picture picture = read_picture(file_);
    EXPECT_EQ(picture.channels, "R, G, B (of the file's own primaries, as linear Rec. 709)");
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.image.mean[0][c], rec709[c], 2e-4);
    EXPECT_EQ(picture.image.samples, 0U) << "a variance in other primaries is unknown";
  }
}

TEST_F(ExrPicture, Rec709BySaysSoIsLeftAlone) {
  const Imf::Chromaticities rounded{{0.64F, 0.33F}, {0.3F, 0.6F}, {0.15F, 0.06F}, {0.313F, 0.329F}};
  tests::write_scan_lines(file_,
                          {{{"R", 1}, {"G", 2}, {"B", 3}}, "", {{0, 0}, {2, 1}}, {{0, 0}, {2, 1}}, rounded});
  expect_pixels(read_picture(file_), {1, 2, 3});
  // Of another layer than a colour, they say nothing.
  tests::write_scan_lines(file_, {{{"Y", 2}}, "", {{0, 0}, {2, 1}}, {{0, 0}, {2, 1}}, rec2020()});
  expect_pixels(read_picture(file_), {2, 2, 2});
}

TEST_F(ExrPicture, PrimariesThatSpanNothingAreRefused) {
  const Imf::Chromaticities flat{{0.6F, 0.3F}, {0.6F, 0.3F}, {0.15F, 0.06F}, {0.3127F, 0.329F}};
  tests::write_scan_lines(file_,
                          {{{"R", 1}, {"G", 2}, {"B", 3}}, "", {{0, 0}, {2, 1}}, {{0, 0}, {2, 1}}, flat});
  EXPECT_TRUE(contains(refusal(), "image.exr: its chromaticities (red 0.6 0.3, ")) << refusal();
}

TEST_F(ExrPicture, SubsampledChromaBecomesRgb) {
  {
    Imf::RgbaOutputFile output(file_.c_str(), 4, 4, Imf::WRITE_YC);
    const std::vector<Imf::Rgba> pixels(16, Imf::Rgba(0.5F, 0.25F, 1.0F));
    output.setFrameBuffer(pixels.data(), 1, 4);
    output.writePixels(4);
  }
  const Picture picture = read_picture(file_);
  ASSERT_EQ(picture.image.pixels(), 16U);
  for (const glm::dvec3& pixel : picture.image.mean) {
    EXPECT_NEAR(pixel.r, 0.5, 0.005);
    EXPECT_NEAR(pixel.g, 0.25, 0.005);
    EXPECT_NEAR(pixel.b, 1, 0.01);
  }
  EXPECT_EQ(picture.channels, "Y with its chroma RY and BY (as RGB)");
}

TEST_F(ExrPicture, Tiles) {
  tests::write_tiles(file_, {{{"R", 1}, {"G", 2}, {"B", 3}}, "", {{0, 0}, {2, 1}}, {{0, 0}, {2, 1}}});
  expect_pixels(read_picture(file_), {1, 2, 3});
}

TEST_F(ExrPicture, PartsAreLayersByTheirNames) {
  const auto part = [](const std::string& name, const std::string& prefix, double value) {
    return TestPart{{{prefix + "R", value}, {prefix + "G", value + 1}, {prefix + "B", value + 2}}, name};
  };
  tests::write_parts(
      file_, {part("depth", "", 7), part("rgba", "", 1), part("ViewLayer.Emit", "ViewLayer.Emit.", 4)});
  expect_pixels(read_picture(file_), {1, 2, 3});  // the only usual name
  expect_pixels(read_picture(file_, "depth"), {7, 8, 9});
  expect_pixels(read_picture(file_, "Emit"), {4, 5, 6});
  tests::write_parts(file_, {part("left", "", 1), part("right", "view.", 4)});
  EXPECT_TRUE(contains(refusal(), "its layers are: left (R, G, B), right.view (view.R, view.G, view.B)"))
      << refusal();
}

TEST_F(ExrPicture, WindowsSayWhereThePixelsAre) {
  tests::write_scan_lines(file_, {{{"R", 1}, {"G", 2}, {"B", 3}}, "", {{4, 5}, {6, 6}}, {{0, 0}, {9, 9}}});
  const Picture picture = read_picture(file_);
  EXPECT_EQ(picture.data, (PixelBox{4, 5, 6, 6}));
  EXPECT_EQ(picture.display, (PixelBox{0, 0, 9, 9}));
  EXPECT_EQ(picture.image.mean[0].r, 1 + 10 * 4 + 100 * 5);
  const RadianceImage part = crop(picture, {5, 6, 6, 6});
  ASSERT_EQ(part.pixels(), 2U);
  EXPECT_EQ(part.mean[0].g, 2 + 10 * 5 + 100 * 6);
  EXPECT_EQ(part.mean[1].g, 2 + 10 * 6 + 100 * 6);
}

TEST_F(ExrPicture, VarianceBelongsToTheMainImage) {
  write({{"R", 1}, {"G", 2}, {"B", 3}, {"variance.R", 4}, {"variance.G", 5}, {"variance.B", 6}});
  const Picture picture = read_picture(file_);
  EXPECT_EQ(picture.image.samples, 2U);
  EXPECT_EQ(picture.image.variance[0], glm::dvec3(4, 5, 6));
  EXPECT_EQ(read_picture(file_, "variance").image.samples, 0U);
}

TEST_F(ExrPicture, BrokenFilesAreNamed) {
  EXPECT_TRUE(contains(refusal(), "image.exr: no such file"));
  write({{"R", 1}, {"G", 2}, {"B", 3}});
  const std::string bytes = folder_.read("image.exr");
  for (const std::size_t size : {std::size_t{0}, bytes.size() / 3, bytes.size() / 2, bytes.size() - 1}) {
    folder_.write("image.exr", bytes.substr(0, size));
    EXPECT_TRUE(contains(refusal(), "image.exr: ")) << size << ": " << refusal();
  }
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::string spoilt = bytes;
    spoilt[i] = static_cast<char>(~spoilt[i]);
    folder_.write("image.exr", spoilt);
    refusal();  // an error or another image, never anything else
  }
}

}  // namespace
}  // namespace qtrace::experiments
