#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>

#include "engine/core/diagnostics.h"
#include "engine/core/errors.h"

namespace lumenline {

/// What a stage may ask of its surroundings: loops, cancellation, and a place for findings.
/// By default everything is serial; the scheduler derives a parallel one. One context serves one
/// task at a time.
class StageContext {
public:
    explicit StageContext(Stage stage, const std::atomic<bool>* cancelled = nullptr)
        : stage_(stage), cancelled_(cancelled) {}
    virtual ~StageContext() = default;
    StageContext(const StageContext&) = delete;
    StageContext& operator=(const StageContext&) = delete;

    /// Calls `body(begin, end)` over disjoint ranges that cover [0, count). The ranges depend on
    /// `count` and `grain` alone, never on the number of threads, and `body` writes only what
    /// belongs to its range: so results do not depend on the thread count.
    virtual void parallel_for(std::size_t count, std::size_t grain,
                              const std::function<void(std::size_t, std::size_t)>& body) const;

    /// Throws StageError kInterrupted when the run was stopped; stages call it in long loops.
    void check_cancelled() const;

    void note(std::string code, std::string message, double value = std::numeric_limits<double>::quiet_NaN(),
              double limit = std::numeric_limits<double>::quiet_NaN());
    void warn(std::string code, std::string message, double value = std::numeric_limits<double>::quiet_NaN(),
              double limit = std::numeric_limits<double>::quiet_NaN());
    void error(std::string code, std::string message, double value = std::numeric_limits<double>::quiet_NaN(),
               double limit = std::numeric_limits<double>::quiet_NaN());

    /// Takes back the findings `first` .. `last` - 1, of an attempt that is thrown away.
    void retract(std::size_t first, std::size_t last);

    [[nodiscard]] Stage stage() const { return stage_; }
    [[nodiscard]] const Diagnostics& diagnostics() const { return diagnostics_; }

private:
    Stage stage_;
    const std::atomic<bool>* cancelled_;
    Diagnostics diagnostics_;
};

}  // namespace lumenline
