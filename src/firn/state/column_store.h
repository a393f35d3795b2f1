#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace firn {

/// How one column of particle data is stored. Declared once; resize, reorder, hash, output and restart are derived from
/// it.
struct ColumnSpec {
  std::string name;  ///< as in output files
  std::string unit;
  std::string help;
  int components = 1;
  int element_bytes = 4;  ///< 4 or 8
};

/// Columns of equal length, each component one contiguous, aligned array (structure of arrays).
///
/// Every component is padded by at least kPadding elements behind the last one, so that whole SIMD vectors can be read.
class ColumnStore {
 public:
  static constexpr std::size_t kPadding = 32;

  ColumnStore() = default;
  ColumnStore(const ColumnStore& other);
  ColumnStore(ColumnStore&&) = default;
  ColumnStore& operator=(const ColumnStore& other);
  ColumnStore& operator=(ColumnStore&&) = default;

  /// Adds a column, filled with zero bytes. Returns its number.
  int add(ColumnSpec spec);

  std::size_t size() const { return size_; }
  /// Keeps the first min(old, new) elements; new ones are zero.
  void resize(std::size_t size);

  /// Element i becomes what element order[i] was. order must be a permutation.
  void reorder(std::span<const std::uint32_t> order);

  /// Removes the elements at these places, ascending. The others keep their order.
  void remove(std::span<const std::uint32_t> places);

  int column_count() const { return static_cast<int>(columns_.size()); }
  const ColumnSpec& spec(int column) const { return columns_[static_cast<std::size_t>(column)].spec; }

  /// First element of component c. T must have the column's element size.
  template <class T>
  T* component(int column, int c = 0) {
    return reinterpret_cast<T*>(bytes(column, c));
  }
  template <class T>
  const T* component(int column, int c = 0) const {
    return reinterpret_cast<const T*>(const_cast<ColumnStore*>(this)->bytes(column, c));
  }

  /// Hash of all columns in order: equal for equal bits.
  std::uint64_t hash() const;

 private:
  struct FreeDeleter {
    void operator()(std::byte* p) const;
  };
  using Buffer = std::unique_ptr<std::byte[], FreeDeleter>;

  struct Column {
    ColumnSpec spec;
    std::vector<Buffer> components;
  };

  std::byte* bytes(int column, int c) {
    return columns_[static_cast<std::size_t>(column)].components[static_cast<std::size_t>(c)].get();
  }
  Buffer allocate(int element_bytes) const;

  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
  std::vector<Column> columns_;
  Buffer spare_[2];  // for reorder: one component of 4-byte and one of 8-byte elements
};

}  // namespace firn
