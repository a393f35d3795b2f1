#include <firn/core/parallel.h>
#include <firn/state/column_store.h>
#include <xxhash.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

namespace firn {
namespace {

constexpr std::size_t kAlignment = 64;
constexpr std::size_t kReorderGrain = 1 << 14;

template <class T>
void permute(const std::byte* from, std::byte* to, std::span<const std::uint32_t> order) {
  const T* source = reinterpret_cast<const T*>(from);
  T* target = reinterpret_cast<T*>(to);
  parallel_chunks(order.size(), kReorderGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) target[i] = source[order[i]];
  });
}

}  // namespace

void ColumnStore::FreeDeleter::operator()(std::byte* p) const { std::free(p); }

ColumnStore::Buffer ColumnStore::allocate(int element_bytes) const {
  const std::size_t bytes = (capacity_ + kPadding) * static_cast<std::size_t>(element_bytes);
  const std::size_t rounded = (bytes + kAlignment - 1) / kAlignment * kAlignment;
  auto* memory = static_cast<std::byte*>(std::aligned_alloc(kAlignment, rounded));
  if (memory == nullptr) throw std::bad_alloc();
  std::memset(memory, 0, rounded);
  return Buffer(memory);
}

ColumnStore::ColumnStore(const ColumnStore& other) : size_(other.size_), capacity_(other.size_) {
  for (const Column& column : other.columns_) {
    Column copy{column.spec, {}};
    for (const Buffer& component : column.components) {
      copy.components.push_back(allocate(column.spec.element_bytes));
      std::memcpy(copy.components.back().get(), component.get(),
                  size_ * static_cast<std::size_t>(column.spec.element_bytes));
    }
    columns_.push_back(std::move(copy));
  }
}

ColumnStore& ColumnStore::operator=(const ColumnStore& other) {
  if (this != &other) *this = ColumnStore(other);
  return *this;
}

int ColumnStore::add(ColumnSpec spec) {
  Column column;
  for (int c = 0; c < spec.components; ++c) column.components.push_back(allocate(spec.element_bytes));
  column.spec = std::move(spec);
  columns_.push_back(std::move(column));
  return column_count() - 1;
}

void ColumnStore::resize(std::size_t size) {
  if (size > capacity_) {
    capacity_ = size;
    for (Buffer& spare : spare_) spare.reset();
    for (Column& column : columns_) {
      for (Buffer& component : column.components) {
        Buffer larger = allocate(column.spec.element_bytes);
        std::memcpy(larger.get(), component.get(), size_ * static_cast<std::size_t>(column.spec.element_bytes));
        component = std::move(larger);
      }
    }
  } else if (size < size_) {
    for (Column& column : columns_) {
      const auto width = static_cast<std::size_t>(column.spec.element_bytes);
      for (Buffer& component : column.components)
        std::memset(component.get() + size * width, 0, (size_ - size) * width);
    }
  }
  size_ = size;
}

void ColumnStore::reorder(std::span<const std::uint32_t> order) {
  for (Column& column : columns_) {
    Buffer& spare = spare_[column.spec.element_bytes == 8 ? 1 : 0];
    if (spare == nullptr) spare = allocate(column.spec.element_bytes);
    for (Buffer& component : column.components) {
      if (column.spec.element_bytes == 8) {
        permute<std::uint64_t>(component.get(), spare.get(), order);
      } else {
        permute<std::uint32_t>(component.get(), spare.get(), order);
      }
      std::swap(component, spare);
    }
  }
}

void ColumnStore::remove(std::span<const std::uint32_t> places) {
  if (places.empty()) return;
  std::vector<std::uint32_t> order;
  order.reserve(size_);
  auto removed = places.begin();
  for (std::uint32_t i = 0; i < size_; ++i) {
    if (removed != places.end() && *removed == i) {
      ++removed;
    } else {
      order.push_back(i);
    }
  }
  const std::size_t kept = order.size();
  order.insert(order.end(), places.begin(), places.end());
  reorder(order);
  resize(kept);
}

std::uint64_t ColumnStore::hash() const {
  std::uint64_t hash = XXH64(&size_, sizeof(size_), 1);
  for (const Column& column : columns_) {
    for (const Buffer& component : column.components) {
      hash = XXH64(component.get(), size_ * static_cast<std::size_t>(column.spec.element_bytes), hash);
    }
  }
  return hash;
}

}  // namespace firn
