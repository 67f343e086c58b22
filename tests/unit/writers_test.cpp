// Files: EXR there and back, broken ones, and writing whole or not at all.
#include "engine/core/check.h"
#include "experiments/commands/compare.h"
#include "experiments/files/atomic_file.h"
#include "experiments/images/exr.h"
#include "experiments/images/exr_images.h"
#include "tests/system/temp_folder.h"

#include <gtest/gtest.h>

namespace qtrace::experiments {
namespace {

RadianceImage image_3x2() {
  RadianceImage image{3, 2, 16, {}, {}};
  for (int i = 0; i < 6; ++i) {
    image.mean.emplace_back(i, 0.5 * i, 1e6 + i);
    image.variance.emplace_back(0.25 * i, 1e-8, 3);
  }
  return image;
}

std::string error_of(const std::filesystem::path& file) {
  try {
    read_exr(file);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(WritersExr, RadianceComesBackWithVarianceAndMetadata) {
  const tests::TempFolder folder;
  const RadianceImage image = image_3x2();
  write_exr(folder / "a.exr", to_exr(image, {{"seed", "4294967295"}, {"configHash", "abc"}}));
  const ExrImage exr = read_exr(folder / "a.exr");
  EXPECT_EQ(exr.metadata.at("seed"), "4294967295");
  EXPECT_EQ(exr.metadata.at("configHash"), "abc");
  EXPECT_EQ(exr.metadata.at("spp"), "16");
  const RadianceImage back = to_radiance(exr, "a.exr");
  EXPECT_EQ(back.width, 3);
  EXPECT_EQ(back.height, 2);
  EXPECT_EQ(back.samples, 16U);
  for (std::size_t i = 0; i < 6; ++i) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(back.mean[i][c], static_cast<float>(image.mean[i][c]));
      EXPECT_EQ(back.variance[i][c], static_cast<float>(image.variance[i][c]));
    }
  }
}

TEST(WritersExr, SameImageSameBytes) {
  const tests::TempFolder folder;
  write_exr(folder / "a.exr", to_exr(image_3x2(), {{"seed", "1"}}));
  write_exr(folder / "b.exr", to_exr(image_3x2(), {{"seed", "1"}}));
  EXPECT_EQ(folder.read("a.exr"), folder.read("b.exr"));
}

TEST(WritersExr, FirstHitHasTwelveChannels) {
  FirstHitImage hit{1, 1, {{0, 1, 0}}, {{1, 2, 3}}, {{0.5F, 0.25F, 1}}, {{0, 0, 7}}};
  const ExrImage exr = to_exr(hit, {});
  EXPECT_EQ(exr.channels.size(), 12U);
  EXPECT_EQ(exr.channels.at("normal.Y"), std::vector<float>{1});
  EXPECT_EQ(exr.channels.at("position.Z"), std::vector<float>{3});
  EXPECT_EQ(exr.channels.at("albedo.G"), std::vector<float>{0.25F});
  EXPECT_EQ(exr.channels.at("emission.B"), std::vector<float>{7});
}

TEST(WritersExr, TheFilteredLayerStandsBesideTheMean) {
  ExrImage exr = to_exr(image_3x2(), {});
  RadianceImage filtered = image_3x2();
  for (glm::dvec3& pixel : filtered.mean) pixel *= 2;
  filtered.variance.clear();
  add_filtered(exr, filtered);
  EXPECT_EQ(exr.channels.size(), 9U);
  EXPECT_EQ(exr.channels.at("filtered.R").at(3), 6);
  EXPECT_EQ(exr.channels.at("R").at(3), 3);
}

TEST(WritersExr, WithoutVarianceTheNoiseIsUnknown) {
  ExrImage exr = to_exr(image_3x2(), {});
  exr.channels.erase("variance.R");
  EXPECT_EQ(to_radiance(exr, "a.exr").samples, 0U);
  exr.channels.erase("G");
  EXPECT_THROW(to_radiance(exr, "a.exr"), Error);
}

TEST(WritersExr, BrokenFilesAreNamed) {
  const tests::TempFolder folder;
  write_exr(folder / "whole.exr", to_exr(image_3x2(), {}));
  const std::string bytes = folder.read("whole.exr");
  EXPECT_NE(error_of(folder / "none.exr").find("none.exr: no such file"), std::string::npos);
  folder.write("text.exr", "this is no image");
  EXPECT_NE(error_of(folder / "text.exr").find("text.exr: cannot be read as an OpenEXR image"),
            std::string::npos);
  for (const std::size_t size : {std::size_t{0}, bytes.size() / 3, bytes.size() / 2, bytes.size() - 1}) {
    folder.write("cut.exr", bytes.substr(0, size));
    EXPECT_NE(error_of(folder / "cut.exr").find("cut.exr: cannot be read"), std::string::npos) << size;
  }
}

TEST(WritersExr, FlippedBytesNeverCrash) {
  const tests::TempFolder folder;
  write_exr(folder / "whole.exr", to_exr(image_3x2(), {}));
  const std::string bytes = folder.read("whole.exr");
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::string spoilt = bytes;
    spoilt[i] = static_cast<char>(~spoilt[i]);
    folder.write("spoilt.exr", spoilt);
    error_of(folder / "spoilt.exr");  // an error or another image, never anything else
  }
}

TEST(WritersAtomic, ReplacesContentAndLeavesNoOtherFile) {
  const tests::TempFolder folder;
  write_file(folder / "a.txt", "old");
  write_file(folder / "a.txt", "new");
  EXPECT_EQ(folder.read("a.txt"), "new");
  const std::filesystem::directory_iterator files(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(WritersAtomic, WithoutCommitTheOldContentStays) {
  const tests::TempFolder folder;
  write_file(folder / "a.txt", "old");
  {
    const AtomicFile file(folder / "a.txt");
    std::ofstream(file.temporary()) << "half";
  }
  EXPECT_EQ(folder.read("a.txt"), "old");
  const std::filesystem::directory_iterator files(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(WritersAtomic, FailuresNameTheTarget) {
  const tests::TempFolder folder;
  try {
    write_file(folder / "none/a.txt", "x");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("none/a.txt: cannot be written"), std::string::npos);
  }
  std::filesystem::create_directories(folder / "taken.txt/inside");
  EXPECT_THROW(write_file(folder / "taken.txt", "x"), Error);
  EXPECT_TRUE(std::filesystem::exists(folder / "taken.txt/inside"));
  folder.write("file", "");
  EXPECT_THROW(make_folder(folder / "file"), Error);
  EXPECT_THROW(make_folder(folder / "file/below"), Error);
}

TEST(WritersCompare, PrintsMetricsAndRefusesOtherSizes) {
  const tests::TempFolder folder;
  RadianceImage image = image_3x2();
  write_exr(folder / "r.exr", to_exr(image, {}));
  for (glm::dvec3& pixel : image.mean) pixel += 1.0;
  write_exr(folder / "a.exr", to_exr(image, {}));
  const std::string table = compare_files({folder / "a.exr", folder / "r.exr"});
  EXPECT_NE(table.find("mse                 1 "), std::string::npos) << table;
  EXPECT_NE(table.find("0 of 6 pixels"), std::string::npos);
  image.width = 2;
  image.height = 3;
  write_exr(folder / "b.exr", to_exr(image, {}));
  EXPECT_THROW(compare_files({folder / "b.exr", folder / "r.exr"}), Error);
}

}  // namespace
}  // namespace qtrace::experiments
