#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace crashrank {

/// A pointer and a length: the one view type of the public headers, the same in C++17 and C++20.
/// It owns nothing; the items have to outlive it. Safe to copy between threads, as a pointer.
template <class T> class View {
public:
  using value_type = std::remove_const_t<T>;  ///< type of the items, without const

  constexpr View() noexcept = default;  ///< A view of no items.
  /// A view of `size` items from `data` on.
  constexpr View(T* data, std::size_t size) noexcept : data_(data), size_(size) {}
  /// A view of a whole vector.
  View(std::vector<value_type>& items) noexcept : data_(items.data()), size_(items.size()) {}
  /// A view of a whole vector.
  template <class U = T, class = std::enable_if_t<std::is_const_v<U>>>
  View(const std::vector<value_type>& items) noexcept : data_(items.data()), size_(items.size()) {}
  /// Converts a view of mutable items to one of constant items.
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

/// Consecutive values that either belong to the column, as those of a std::vector, or lie in
/// immutable memory with another owner, such as a mapped file. Reading is the same, a pointer and a
/// length; the first change of a borrowed column copies it, so that a column behaves as a value
/// always. A copy of a borrowed column borrows from the same keeper, at no cost.
///
/// Members that are not const give mutable access: read a borrowed column through a const
/// reference, since calling begin() on one that is not const copies it. Safe to read from many
/// threads. Changing throws only what std::vector throws.
template <class T> class Column {
public:
  using value_type = T;                    ///< what it holds
  using size_type = std::size_t;           ///< of sizes and indices
  using difference_type = std::ptrdiff_t;  ///< of iterators
  using reference = T&;                    ///< to an item
  using const_reference = const T&;        ///< to an item
  using iterator = T*;                     ///< to an item
  using const_iterator = const T*;         ///< to an item

  Column() noexcept = default;
  /// Owns these items.
  Column(std::initializer_list<T> items) : own_(items) { refresh(); }
  /// Owns these items.
  Column(std::vector<T> items) noexcept : own_(std::move(items)) { refresh(); }
  /// Owns this number of items.
  explicit Column(std::size_t size) : own_(size) { refresh(); }

  /// A column over memory that stays as it is for as long as `keeper` lives. The memory has to be
  /// aligned for T. `keeper` is not empty.
  static Column borrow(View<const T> items, std::shared_ptr<const void> keeper) noexcept {
    assert(keeper != nullptr);
    Column column;
    column.keeper_.swap(keeper);
    column.data_ = items.data();
    column.size_ = items.size();
    return column;
  }

  /// A copy; the copy of a borrowed column borrows from the same keeper.
  Column(const Column& other)
      : own_(other.own_),
        keeper_(other.keeper_),
        data_(other.keeper_ != nullptr ? other.data_ : own_.data()),
        size_(other.size_) {}
  /// Moves; the other is empty afterwards.
  Column(Column&& other) noexcept
      : own_(std::move(other.own_)),
        keeper_(std::move(other.keeper_)),
        data_(other.data_),
        size_(other.size_) {
    other.reset();
  }
  /// As the constructors.
  Column& operator=(const Column& other) {
    if (this != &other) *this = Column(other);
    return *this;
  }
  /// As the constructors.
  Column& operator=(Column&& other) noexcept {
    if (this == &other) return *this;
    own_ = std::move(other.own_);
    keeper_ = std::move(other.keeper_);
    data_ = other.data_;
    size_ = other.size_;
    other.reset();
    return *this;
  }
  /// As the constructors.
  Column& operator=(std::initializer_list<T> items) { return *this = Column(items); }
  ~Column() = default;

  /// True if the values lie in borrowed memory.
  bool borrowed() const noexcept { return keeper_ != nullptr; }

  /// How many items.
  std::size_t size() const noexcept { return size_; }
  /// True without any.
  bool empty() const noexcept { return size_ == 0; }
  /// The first item.
  const T* data() const noexcept { return data_; }
  /// The first item.
  const T* begin() const noexcept { return data_; }
  /// Behind the last item.
  const T* end() const noexcept { return data_ + size_; }
  /// The item with that index, below `size`.
  const T& operator[](std::size_t i) const noexcept { return data_[i]; }
  /// The first item.
  const T& front() const noexcept { return data_[0]; }
  /// The last item.
  const T& back() const noexcept { return data_[size_ - 1]; }
  /// A view of all items.
  operator View<const T>() const noexcept { return {data_, size_}; }

  /// The first item, to change.
  T* data() { return own().data(); }
  /// The first item, to change.
  T* begin() { return data(); }
  /// Behind the last item.
  T* end() { return data() + size_; }
  /// The item with that index, to change.
  T& operator[](std::size_t i) { return data()[i]; }
  /// The first item, to change.
  T& front() { return data()[0]; }
  /// The last item, to change.
  T& back() { return data()[size_ - 1]; }
  /// A mutable view of all items.
  operator View<T>() { return {data(), size_}; }

  /// As of std::vector.
  void reserve(std::size_t size) {
    own().reserve(size);
    refresh();
  }
  /// As of std::vector.
  void resize(std::size_t size) {
    own().resize(size);
    refresh();
  }
  /// As of std::vector.
  void resize(std::size_t size, const T& value) {
    own().resize(size, value);
    refresh();
  }
  /// As of std::vector.
  void assign(std::size_t size, const T& value) { *this = Column(std::vector<T>(size, value)); }
  /// As of std::vector.
  void clear() noexcept {
    own_.clear();
    reset();
  }
  /// As of std::vector.
  void push_back(const T& value) {
    own().push_back(value);
    refresh();
  }
  /// As of std::vector.
  template <class... Args> T& emplace_back(Args&&... args) {
    own().emplace_back(std::forward<Args>(args)...);
    refresh();
    return own_.back();
  }
  /// As of std::vector.
  void pop_back() {
    own().pop_back();
    refresh();
  }
  /// As of std::vector.
  template <class Iterator> T* insert(const T* place, Iterator first, Iterator last) {
    const std::ptrdiff_t at = place - data_;
    std::vector<T>& items = own();
    items.insert(items.begin() + at, first, last);
    refresh();
    return own_.data() + at;
  }
  /// As of std::vector.
  T* insert(const T* place, std::initializer_list<T> items) {
    return insert(place, items.begin(), items.end());
  }
  /// As of std::vector.
  T* erase(const T* first, const T* last) {
    const std::ptrdiff_t at = first - data_;
    const std::ptrdiff_t end = last - data_;
    std::vector<T>& items = own();
    items.erase(items.begin() + at, items.begin() + end);
    refresh();
    return own_.data() + at;
  }

  /// Equal items in the same order.
  friend bool operator==(const Column& a, const Column& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }
  /// Other items, or another order.
  friend bool operator!=(const Column& a, const Column& b) { return !(a == b); }

private:
  std::vector<T>& own() {
    if (keeper_ != nullptr) copy_borrowed();
    return own_;
  }
  // Out of line: callers in hot loops should not grow by what happens once.
  [[gnu::noinline, gnu::cold]] void copy_borrowed() {
    own_.assign(data_, data_ + size_);
    keeper_.reset();
    refresh();
  }
  void refresh() noexcept {
    data_ = own_.data();
    size_ = own_.size();
  }
  void reset() noexcept {
    keeper_.reset();
    refresh();
  }

  std::vector<T> own_;                  ///< empty while borrowed
  std::shared_ptr<const void> keeper_;  ///< empty while owned
  const T* data_ = nullptr;             ///< own_'s or the keeper's
  std::size_t size_ = 0;
};

}  // namespace crashrank
