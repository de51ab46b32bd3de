#pragma once

#include <cstddef>
#include <type_traits>
#include <vector>

namespace crashrank {

/// A pointer and a length: the one view type of the public headers, the same in C++17 and C++20.
/// It owns nothing; what it looks at has to outlive it. Safe to copy between threads, as a pointer.
template <class T> class View {
public:
  using value_type = std::remove_const_t<T>;  ///< what it looks at, without const

  constexpr View() noexcept = default;  ///< Looks at nothing.
  /// Looks at `size` items from `data` on.
  constexpr View(T* data, std::size_t size) noexcept : data_(data), size_(size) {}
  /// Looks at a whole vector.
  View(std::vector<value_type>& items) noexcept : data_(items.data()), size_(items.size()) {}
  /// Looks at a whole vector.
  template <class U = T, class = std::enable_if_t<std::is_const_v<U>>>
  View(const std::vector<value_type>& items) noexcept : data_(items.data()), size_(items.size()) {}
  /// A view of items that may change, as one that does not change them.
  template <class U, class = std::enable_if_t<std::is_same_v<const U, T>>>
  constexpr View(View<U> items) noexcept : data_(items.data()), size_(items.size()) {}

  /// The first item.
  constexpr T* data() const noexcept { return data_; }
  /// How many items.
  constexpr std::size_t size() const noexcept { return size_; }
  /// True without any.
  constexpr bool empty() const noexcept { return size_ == 0; }
  /// The first item.
  constexpr T* begin() const noexcept { return data_; }
  /// Behind the last item.
  constexpr T* end() const noexcept { return data_ + size_; }
  /// The item with that index, below `size`.
  constexpr T& operator[](std::size_t i) const noexcept { return data_[i]; }

private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace crashrank
