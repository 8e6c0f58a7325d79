#include "heap.h"

#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <new>

namespace {

std::size_t now = 0, most = 0;  // [bytes], of a program that measures itself

void* counted(void* p) {
    if (p == nullptr) throw std::bad_alloc();
    now += malloc_usable_size(p);
    most = std::max(most, now);
    return p;
}

void give_back(void* p) {
    now -= malloc_usable_size(p);
    std::free(p);
}

}  // namespace

void* operator new(std::size_t size) { return counted(std::malloc(size)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    const auto a = static_cast<std::size_t>(alignment);
    return counted(std::aligned_alloc(a, (size + a - 1) / a * a));
}
void operator delete(void* p) noexcept { give_back(p); }
void operator delete(void* p, std::size_t) noexcept { give_back(p); }
void operator delete(void* p, std::align_val_t) noexcept { give_back(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { give_back(p); }

namespace kropla::heap {

std::size_t bytes() { return now; }
std::size_t peak_bytes() { return most; }
void reset_peak() { most = now; }

}  // namespace kropla::heap
