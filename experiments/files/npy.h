// Tables of numbers as NumPy keeps them: numpy.load(file) gives them back. Format 1.0 of numpy.lib.format
// ("A Simple File Format for NumPy Arrays", NumPy Enhancement Proposal 1): little-endian, row by row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace qtrace::experiments {

// T: float ('<f4') or std::uint32_t ('<u4').
template <class T>
struct NpyTable {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<T> values;  // rows * columns
};

// The file's content: rows of `columns` values. Throws Error where the values do not fill them.
template <class T>
std::string npy_text(std::size_t columns, std::span<const T> values);

// Replaces the file whole or not at all. Throws Error.
template <class T>
void write_npy(const std::filesystem::path& file, std::size_t columns, std::span<const T> values);

// Throws Error that names the file: missing, no NumPy file of version 1.0, other numbers than T, no table of
// two dimensions in rows, or not as long as its shape says.
template <class T>
NpyTable<T> read_npy(const std::filesystem::path& file);

}  // namespace qtrace::experiments
