#pragma once

/// Marks of happens-before for the thread sanitizer. oneTBB's library is not built with it, so the
/// sanitizer cannot see that a task's writes are handed to the task that follows it. Each node says
/// so: `taken(x)` on entry, `handed_on(x)` on exit. Tasks that overlap in time stay unordered by
/// this, so races between them are still found. Outside of sanitizer builds these do nothing.

#if defined(__SANITIZE_THREAD__)
extern "C" {
void __tsan_acquire(void* address);
void __tsan_release(void* address);
}
#endif

namespace lumenline {

inline void taken([[maybe_unused]] const void* object) {
#if defined(__SANITIZE_THREAD__)
    __tsan_acquire(const_cast<void*>(object));
#endif
}

inline void handed_on([[maybe_unused]] const void* object) {
#if defined(__SANITIZE_THREAD__)
    __tsan_release(const_cast<void*>(object));
#endif
}

/// Both for the lifetime of a scope.
class Handover {
public:
    explicit Handover(const void* object) : object_(object) { taken(object_); }
    ~Handover() { handed_on(object_); }
    Handover(const Handover&) = delete;
    Handover& operator=(const Handover&) = delete;

private:
    const void* object_;
};

}  // namespace lumenline
