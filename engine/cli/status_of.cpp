#include "engine/cli/status_of.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "config/cohort.h"
#include "engine/cli/run.h"
#include "engine/population/study.h"
#include "io/archive/commit.h"
#include "io/archive/errors.h"
#include "io/archive/lease.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

/// Names in the sentence come from a file, which may be anybody's.
int refused(const std::exception& error, ExitStatus status) {
    fmt::print(stderr, "lumenline: {}\n", printable(error.what()));
    return status;
}

}  // namespace

int status_of(const std::function<int()>& action) {
    try {
        return action();
    } catch (const CLI::Error&) {
        throw;
    } catch (const ConfigError& error) {
        fmt::print(stderr, "{}\n", error.what());
        return kUsage;
    } catch (const LeaseHeld& held) {
        fmt::print(stderr, "{}\n", held.what());
        return kUsage;
    } catch (const OutputTaken& error) {
        return refused(error, kUsage);
    } catch (const UnknownName& error) {
        return refused(error, kUsage);
    } catch (const StudyError& error) {
        return refused(error, kUsage);
    } catch (const std::exception& error) {
        return refused(error, kModelFailed);
    }
}

}  // namespace lumenline
