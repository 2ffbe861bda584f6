#include <string.h>

#include "material/block_image.h"

double *tally_spared(const struct tally *tally, const struct gamut_chunk *chunk)
{
  const struct spare *spare = tally->spare;
  return spare && spare->mark[chunk->set->index] > 0.0 ? chunk->end[spare->component] : NULL;
}

void tally_block(struct tally *tally, const int64_t *status, const struct gamut_chunk *chunk)
{
  int64_t any = 0;
#pragma omp simd reduction(| : any)
  for (size_t i = 0; i < chunk->count; i++)
    any |= status[i];
  if (!any)
    return;
  const int64_t *id = chunk->set->id + chunk->slot;
  double *removal = tally_spared(tally, chunk);
  for (size_t i = 0; i < chunk->count; i++) {
    /* padding is marked with the point that it copies: its state is no better */
    if (removal && status[i] >> 8 == GAMUT_STOP && !(removal[i] > 0.0))
      removal[i] = tally->spare->mark[chunk->set->index];
    if (!status[i] || id[i] < 0)
      continue;
    size_t message = (size_t)(status[i] & 255);
    if (message < TALLY_MESSAGES)
      tally->count[message]++;
    if (status[i] >> 8 != GAMUT_STOP || removal)
      continue;
    size_t set = chunk->set->index;
    if (!tally->stopped || set < tally->set || (set == tally->set && id[i] < tally->id)) {
      tally->stopped = true;
      tally->set = set;
      tally->id = id[i];
      tally->message = message;
    }
  }
}

static struct tally *tally_at(const struct tally *tally, size_t stride, size_t thread)
{
  return (struct tally *)(void *)((char *)(size_t)tally + stride * thread);
}

bool tally_report(const struct tally *tally, size_t tallies, size_t stride,
                  const struct descriptor *d, size_t *index, struct flag_report *report)
{
  for (size_t m = 0; m < d->messages && m < TALLY_MESSAGES; m++) {
    uint64_t count = 0;
    for (size_t t = 0; t < tallies; t++)
      count += tally_at(tally, stride, t)->count[m];
    if (!count)
      continue;
    if (*index == 0) {
      *report = (struct flag_report){d, &d->message[m], count};
      return true;
    }
    --*index;
  }
  return false;
}

bool tally_stopped(struct tally *tally, size_t tallies, size_t stride, const struct descriptor *d,
                   struct flag_stop *stop)
{
  bool found = false;
  for (size_t t = 0; t < tallies; t++) {
    struct tally *one = tally_at(tally, stride, t);
    if (!one->stopped)
      continue;
    one->stopped = false;
    if (!found || one->set < stop->set || (one->set == stop->set && one->id < stop->id))
      *stop = (struct flag_stop){d, one->message < d->messages ? &d->message[one->message] : NULL,
                                 one->set, one->id};
    found = true;
  }
  return found;
}

void tally_counts(const struct tally *tally, size_t tallies, size_t stride, int64_t *count)
{
  for (size_t m = 0; m < TALLY_MESSAGES; m++) {
    count[m] = 0;
    for (size_t t = 0; t < tallies; t++)
      count[m] += (int64_t)tally_at(tally, stride, t)->count[m];
  }
}

void tally_go_on(struct tally *tally, size_t tallies, size_t stride, const int64_t *count)
{
  for (size_t t = 0; t < tallies; t++)
    for (size_t m = 0; m < TALLY_MESSAGES; m++)
      tally_at(tally, stride, t)->count[m] = t ? 0 : (uint64_t)count[m];
}
