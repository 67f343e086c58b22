// NumPy files: there and back, what NumPy itself would write, and broken ones.
#include "experiments/files/npy.h"

#include "engine/core/check.h"
#include "tests/system/temp_folder.h"

#include <gtest/gtest.h>

#include <limits>

namespace qtrace::experiments {
namespace {

const std::vector<float> kFloats{0, -0.0F, 1e-38F, std::numeric_limits<float>::infinity(), 0.1F, -3};

template <class T>
std::string error_of(const std::filesystem::path& file) {
  try {
    read_npy<T>(file);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// The bytes of numpy.save for a 2 x 3 array of this header: a preamble that is filled up to 128 bytes.
std::string numpy_file(const std::string& header, const std::string& numbers) {
  std::string text("\x93NUMPY\x01\x00\x76\x00", 10);
  text += header;
  text.append(127 - text.size(), ' ');
  return text + '\n' + numbers;
}

TEST(Npy, TablesComeBack) {
  const tests::TempFolder folder;
  write_npy<float>(folder / "f.npy", 2, kFloats);
  const NpyTable<float> floats = read_npy<float>(folder / "f.npy");
  EXPECT_EQ(floats.rows, 3U);
  EXPECT_EQ(floats.columns, 2U);
  EXPECT_EQ(floats.values, kFloats);
  const std::vector<std::uint32_t> counts{0, 1, 4294967295};
  write_npy<std::uint32_t>(folder / "u.npy", 3, counts);
  const NpyTable<std::uint32_t> back = read_npy<std::uint32_t>(folder / "u.npy");
  EXPECT_EQ(back.rows, 1U);
  EXPECT_EQ(back.values, counts);
}

TEST(Npy, BytesAreThoseOfNumPy) {
  const tests::TempFolder folder;
  write_npy<float>(folder / "f.npy", 3, kFloats);
  const std::string numbers(reinterpret_cast<const char*>(kFloats.data()), 24);
  const std::string wanted =
      numpy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }", numbers);
  EXPECT_EQ(folder.read("f.npy"), wanted);
}

TEST(Npy, AnEmptyTableIsATable) {
  const tests::TempFolder folder;
  write_npy<float>(folder / "f.npy", 3, std::vector<float>{});
  EXPECT_EQ(read_npy<float>(folder / "f.npy").rows, 0U);
}

TEST(Npy, BrokenFilesAreNamed) {
  const tests::TempFolder folder;
  EXPECT_TRUE(contains(error_of<float>(folder / "none.npy"), "none.npy: cannot be read"));
  folder.write("text.npy", "no table at all, but long enough");
  EXPECT_TRUE(contains(error_of<float>(folder / "text.npy"), "text.npy: is no NumPy file of version 1.0"));
  write_npy<float>(folder / "f.npy", 2, kFloats);
  EXPECT_TRUE(contains(error_of<std::uint32_t>(folder / "f.npy"), "type '<f4' where '<u4' is needed"));
  const std::string whole = folder.read("f.npy");
  for (const std::string& other : {whole.substr(0, whole.size() - 1), whole + "x"}) {
    folder.write("cut.npy", other);
    EXPECT_TRUE(contains(error_of<float>(folder / "cut.npy"), "which is not 3 x 2 of them")) << other.size();
  }
  folder.write("head.npy", whole.substr(0, 40));
  EXPECT_TRUE(contains(error_of<float>(folder / "head.npy"), "the header is damaged"));
  const auto with_shape = [&folder](const std::string& order, const std::string& shape) {
    folder.write("shape.npy",
                 numpy_file("{'descr': '<f4', 'fortran_order': " + order + ", 'shape': (" + shape + "), }",
                            std::string(24, '\0')));
    return error_of<float>(folder / "shape.npy");
  };
  EXPECT_EQ(with_shape("False", "3, 2"), "no error");
  EXPECT_TRUE(contains(with_shape("False", "6,"), "shape (6,) where rows and columns are needed"));
  EXPECT_TRUE(contains(with_shape("False", "1, 2, 3"), "where rows and columns"));
  EXPECT_TRUE(contains(with_shape("True", "2, 3"), "by columns where rows"));
  EXPECT_TRUE(contains(with_shape("False", "99999999999999999999, 2"), "where rows and columns"));
  EXPECT_TRUE(contains(with_shape("False", "4611686018427387906, 4"), "truncated or damaged"));
  EXPECT_TRUE(contains(with_shape("False", "6, 0"), "truncated or damaged"));
}

TEST(Npy, ValuesThatFillNoRowsAreRefused) {
  const tests::TempFolder folder;
  EXPECT_THROW(write_npy<float>(folder / "f.npy", 4, kFloats), Error);
  EXPECT_THROW(write_npy<float>(folder / "f.npy", 0, kFloats), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "f.npy"));
}

}  // namespace
}  // namespace qtrace::experiments
