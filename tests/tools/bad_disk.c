// Preloaded into the program: a disk that fails on one file. BAD_DISK="CALL:ERRNO:COUNT:NAME", CALL one of open, write,
// fsync: from the COUNT-th such call on a file whose path ends with NAME on, the call fails with the number ERRNO.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int is_bad(const char* call, const char* path) {
  static int seen = 0;
  char wanted[16] = "", name[256] = "";
  int error = 0, count = 0;
  const char* plan = getenv("BAD_DISK");
  if (!plan || sscanf(plan, "%15[^:]:%d:%d:%255s", wanted, &error, &count, name) != 4) return 0;
  const size_t length = strlen(path), tail = strlen(name);
  if (strcmp(wanted, call) != 0 || length < tail || strcmp(path + length - tail, name) != 0) return 0;
  if (++seen < count) return 0;
  errno = error;
  return 1;
}

static int is_bad_file(const char* call, int fd) {
  char link[64], path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t n = readlink(link, path, sizeof path - 1);
  if (n < 0) return 0;
  path[n] = 0;
  return is_bad(call, path);
}

static int open_with(const char* symbol, const char* path, int flags, mode_t mode) {
  int (*next)(const char*, int, mode_t) = (int (*)(const char*, int, mode_t))dlsym(RTLD_NEXT, symbol);
  if ((flags & O_ACCMODE) != O_RDONLY && is_bad("open", path)) return -1;
  return next(path, flags, mode);
}

static mode_t mode_of(int flags, va_list rest) { return flags & O_CREAT ? va_arg(rest, mode_t) : 0; }

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return open_with("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return open_with("open64", path, flags, mode);
}

ssize_t write(int fd, const void* bytes, size_t size) {
  ssize_t (*next)(int, const void*, size_t) = (ssize_t(*)(int, const void*, size_t))dlsym(RTLD_NEXT, "write");
  return is_bad_file("write", fd) ? -1 : next(fd, bytes, size);
}

int fsync(int fd) {
  int (*next)(int) = (int (*)(int))dlsym(RTLD_NEXT, "fsync");
  return is_bad_file("fsync", fd) ? -1 : next(fd);
}
