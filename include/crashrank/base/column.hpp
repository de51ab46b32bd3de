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
  using value_type = T;
  using size_type = std::size_t;
  using difference_type = std::ptrdiff_t;
  using reference = T&;
  using const_reference = const T&;
  using iterator = T*;
  using const_iterator = const T*;

  Column() noexcept = default;
  Column(std::initializer_list<T> items) : own_(items) { refresh(); }
  Column(std::vector<T> items) noexcept : own_(std::move(items)) { refresh(); }
  explicit Column(std::size_t size) : own_(size) { refresh(); }

  /// A column over memory that stays as it is for as long as `keeper` lives. The memory has to be
  /// aligned for T. `keeper` is not empty.
  static Column borrow(View<const T> items, std::shared_ptr<const void> keeper) noexcept {
    assert(keeper != nullptr);
    Column column;
    column.keeper_ = std::move(keeper);
    column.data_ = items.data();
    column.size_ = items.size();
    return column;
  }

  Column(const Column& other)
      : own_(other.own_),
        keeper_(other.keeper_),
        data_(other.keeper_ != nullptr ? other.data_ : own_.data()),
        size_(other.size_) {}
  Column(Column&& other) noexcept
      : own_(std::move(other.own_)),
        keeper_(std::move(other.keeper_)),
        data_(other.data_),
        size_(other.size_) {
    other.reset();
  }
  Column& operator=(const Column& other) {
    if (this != &other) *this = Column(other);
    return *this;
  }
  Column& operator=(Column&& other) noexcept {
    if (this == &other) return *this;
    own_ = std::move(other.own_);
    keeper_ = std::move(other.keeper_);
    data_ = other.data_;
    size_ = other.size_;
    other.reset();
    return *this;
  }
  Column& operator=(std::initializer_list<T> items) { return *this = Column(items); }
  ~Column() = default;

  /// Whether the values lie in somebody else's memory.
  bool borrowed() const noexcept { return keeper_ != nullptr; }

  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }
  const T* data() const noexcept { return data_; }
  const T* begin() const noexcept { return data_; }
  const T* end() const noexcept { return data_ + size_; }
  const T& operator[](std::size_t i) const noexcept { return data_[i]; }
  const T& front() const noexcept { return data_[0]; }
  const T& back() const noexcept { return data_[size_ - 1]; }
  operator View<const T>() const noexcept { return {data_, size_}; }

  T* data() { return own().data(); }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  T& operator[](std::size_t i) { return data()[i]; }
  T& front() { return data()[0]; }
  T& back() { return data()[size_ - 1]; }
  operator View<T>() { return {data(), size_}; }

  void reserve(std::size_t size) {
    own().reserve(size);
    refresh();
  }
  void resize(std::size_t size) {
    own().resize(size);
    refresh();
  }
  void resize(std::size_t size, const T& value) {
    own().resize(size, value);
    refresh();
  }
  void assign(std::size_t size, const T& value) { *this = Column(std::vector<T>(size, value)); }
  void clear() noexcept {
    own_.clear();
    reset();
  }
  void push_back(const T& value) {
    own().push_back(value);
    refresh();
  }
  template <class... Args> T& emplace_back(Args&&... args) {
    own().emplace_back(std::forward<Args>(args)...);
    refresh();
    return own_.back();
  }
  void pop_back() {
    own().pop_back();
    refresh();
  }
  template <class Iterator> T* insert(const T* place, Iterator first, Iterator last) {
    const std::ptrdiff_t at = place - data_;
    std::vector<T>& items = own();
    items.insert(items.begin() + at, first, last);
    refresh();
    return own_.data() + at;
  }
  T* insert(const T* place, std::initializer_list<T> items) {
    return insert(place, items.begin(), items.end());
  }
  T* erase(const T* first, const T* last) {
    const std::ptrdiff_t at = first - data_;
    const std::ptrdiff_t end = last - data_;
    std::vector<T>& items = own();
    items.erase(items.begin() + at, items.begin() + end);
    refresh();
    return own_.data() + at;
  }

  friend bool operator==(const Column& a, const Column& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }
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
