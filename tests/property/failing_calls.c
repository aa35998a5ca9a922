/* Stands before the C library and lets the n-th call that touches a folder fail, or kills before it.
 *
 * Preloaded (LD_PRELOAD). Counted are calls by a path below the folder, and by a descriptor that was
 * opened by such a path. `failing_calls_arm` sets the folder, the number of the call, from 0, and
 * the error; a negative number counts alone. In place of the error -1 kills the process (SIGKILL)
 * before the call is made.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

static char folder[4096];
static atomic_long count;
static long failing = -1;
static int failure;
static atomic_uchar watched[65536]; /* descriptors */
static const char *volatile failed_call = "";

void failing_calls_arm(const char *path, long number, int error) {
    strncpy(folder, path, sizeof folder - 1);
    atomic_store(&count, 0);
    failing = number;
    failure = error;
    failed_call = "";
}

long failing_calls_count(void) { return atomic_load(&count); }
const char *failing_calls_which(void) { return failed_call; }

static int fails(const char *name) {
    if (!folder[0]) return 0;
    long number = atomic_fetch_add(&count, 1);
    if (number != failing) return 0;
    failed_call = name;
    if (failure < 0) raise(SIGKILL);
    errno = failure;
    return 1;
}

static int below(const char *path) {
    size_t length = strlen(folder);
    return length && path && strncmp(path, folder, length) == 0;
}

static int of(int fd) { return fd >= 0 && fd < 65536 && atomic_load(&watched[fd]); }

static int opened(int fd, int is_below) {
    if (fd >= 0 && fd < 65536) atomic_store(&watched[fd], is_below);
    return fd;
}

#define REAL(name) __typeof__(&name) real = (__typeof__(&name))dlsym(RTLD_NEXT, #name)
#define MODE(flags)                                    \
    mode_t mode = 0;                                   \
    if ((flags) & (O_CREAT | O_TMPFILE)) {             \
        va_list rest;                                  \
        va_start(rest, flags);                         \
        mode = va_arg(rest, mode_t);                   \
        va_end(rest);                                  \
    }

int open(const char *path, int flags, ...) {
    MODE(flags) REAL(open);
    int is_below = below(path);
    return is_below && fails("open") ? -1 : opened(real(path, flags, mode), is_below);
}
int open64(const char *path, int flags, ...) {
    MODE(flags) REAL(open64);
    int is_below = below(path);
    return is_below && fails("open") ? -1 : opened(real(path, flags, mode), is_below);
}
int openat(int at, const char *path, int flags, ...) {
    MODE(flags) REAL(openat);
    int is_below = below(path);
    return is_below && fails("open") ? -1 : opened(real(at, path, flags, mode), is_below);
}
int openat64(int at, const char *path, int flags, ...) {
    MODE(flags) REAL(openat64);
    int is_below = below(path);
    return is_below && fails("open") ? -1 : opened(real(at, path, flags, mode), is_below);
}
int close(int fd) {
    REAL(close);
    if (fd >= 0 && fd < 65536) atomic_store(&watched[fd], 0);
    return real(fd);
}
ssize_t write(int fd, const void *data, size_t size) {
    REAL(write);
    return of(fd) && fails("write") ? -1 : real(fd, data, size);
}
ssize_t writev(int fd, const struct iovec *data, int pieces) {
    REAL(writev);
    return of(fd) && fails("write") ? -1 : real(fd, data, pieces);
}
int ftruncate(int fd, off_t size) {
    REAL(ftruncate);
    return of(fd) && fails("ftruncate") ? -1 : real(fd, size);
}
int ftruncate64(int fd, off64_t size) {
    REAL(ftruncate64);
    return of(fd) && fails("ftruncate") ? -1 : real(fd, size);
}
int fsync(int fd) {
    REAL(fsync);
    return of(fd) && fails("fsync") ? -1 : real(fd);
}
int syncfs(int fd) {
    REAL(syncfs);
    return of(fd) && fails("syncfs") ? -1 : real(fd);
}
int rename(const char *from, const char *to) {
    REAL(rename);
    return below(to) && fails("rename") ? -1 : real(from, to);
}
int mkdir(const char *path, mode_t mode) {
    REAL(mkdir);
    return below(path) && fails("mkdir") ? -1 : real(path, mode);
}
int link(const char *from, const char *to) {
    REAL(link);
    return below(to) && fails("link") ? -1 : real(from, to);
}
int symlink(const char *from, const char *to) {
    REAL(symlink);
    return below(to) && fails("symlink") ? -1 : real(from, to);
}
int unlink(const char *path) {
    REAL(unlink);
    return below(path) && fails("unlink") ? -1 : real(path);
}
