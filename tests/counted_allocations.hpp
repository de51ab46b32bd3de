#pragma once

// Counts what a test program allocates: replaces operator new and delete. Include it in one source
// of a program.

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <thread>

namespace crashrank::test {

inline std::atomic<long> allocations{0};
/// While it is set, allocations fail in all threads but the one that started the program.
inline std::atomic<bool> other_threads_fail{false};
inline const std::thread::id first_thread = std::this_thread::get_id();

inline void* counted_allocation(std::size_t bytes, std::size_t alignment) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  if (other_threads_fail.load(std::memory_order_relaxed) &&
      std::this_thread::get_id() != first_thread) {
    throw std::bad_alloc();
  }
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  void* const memory = std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace crashrank::test

// Not inlined: a compiler that sees one of a pair alone takes them for mismatched.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
  return crashrank::test::counted_allocation(bytes, alignof(std::max_align_t));
}
[[gnu::noinline]] void* operator new[](std::size_t bytes) {
  return crashrank::test::counted_allocation(bytes, alignof(std::max_align_t));
}
[[gnu::noinline]] void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return crashrank::test::counted_allocation(bytes, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  try {
    return ::operator new(bytes);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
