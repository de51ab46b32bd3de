#pragma once

#include "crashrank/base/view.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace crashrank {

/// Consecutive values that either belong to the column, as those of a std::vector, or lie in
/// immutable memory that someone else keeps alive, as a mapped file does. Reading is the same, a
/// pointer and a length; the first change of a borrowed column copies it, so that a column behaves
/// as a value always. A copy of a borrowed column borrows from the same keeper, at no cost.
///
/// What may change hands out mutable access, so borrowed columns of one object are best read
/// through a const reference: calling begin() on one that is not const copies it.
/// Safe to read from many threads. Changing throws only what std::vector throws.
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
  /// Its own, with these items.
  Column(std::initializer_list<T> items) : own_(items) { refresh(); }
  /// Its own, with these items.
  Column(std::vector<T> items) noexcept : own_(std::move(items)) { refresh(); }
  /// Its own, with so many items.
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

  /// A copy; of a borrowed column one that borrows, too.
  Column(const Column& other)
      : own_(other.own_),
        keeper_(other.keeper_),
        data_(other.keeper_ != nullptr ? other.data_ : own_.data()),
        size_(other.size_) {}
  /// Moves; the other is empty then.
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

  /// Whether the values lie in somebody else's memory.
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
  /// A look at all items.
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
  /// A look at all items, to change them.
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
