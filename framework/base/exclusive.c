#include "base/exclusive.h"

#include <pthread.h>

/* The one variable of the library beside constants: what it guards are variables of other
 * libraries, of which there is one set a process. */
static pthread_mutex_t lock;
static pthread_once_t made = PTHREAD_ONCE_INIT;
static _Thread_local int depth;

static void make(void)
{
  pthread_mutexattr_t kind;
  pthread_mutexattr_init(&kind);
  pthread_mutexattr_settype(&kind, PTHREAD_MUTEX_RECURSIVE);
  pthread_mutex_init(&lock, &kind);
  pthread_mutexattr_destroy(&kind);
}

void exclusive_begin(void)
{
  pthread_once(&made, make);
  pthread_mutex_lock(&lock);
  depth++;
}

void exclusive_end(const int *here)
{
  (void)here;
  depth--;
  pthread_mutex_unlock(&lock);
}

bool exclusive_is_mine(void)
{
  return depth > 0;
}
