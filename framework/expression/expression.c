#include "expression/expression.h"
#include "base/array.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <muParserDLL.h>

#include "base/error.h"
#include "base/exclusive.h"

/* muParser's C interface copies names and messages, unchecked, to a buffer of 2048 bytes: a formula
 * must be so short that no word of it can run over. */
enum { TEXT_MAX = 1001, NAME_LENGTH_MAX = 100 };

static const double pi = 3.14159265358979323846;

struct expression {
  muParserHandle_t parser;
  double *slot; /* what the parser reads, one for each variable */
  bool *used;
  size_t count;
};

/* muParser's own functions are cleared, so that the list in the header is the whole list and "log"
 * is the natural logarithm whatever the version of muParser. */

static double least(const double *value, int count)
{
  double result = count > 0 ? value[0] : NAN;
  for (int k = 1; k < count; k++)
    result = fmin(result, value[k]);
  return result;
}

static double most(const double *value, int count)
{
  double result = count > 0 ? value[0] : NAN;
  for (int k = 1; k < count; k++)
    result = fmax(result, value[k]);
  return result;
}

static const struct {
  const char *name;
  double (*call)(double);
} functions[] = {
    {"sqrt", sqrt}, {"exp", exp},   {"log", log},   {"log10", log10}, {"sin", sin},
    {"cos", cos},   {"tan", tan},   {"asin", asin}, {"acos", acos},   {"atan", atan},
    {"sinh", sinh}, {"cosh", cosh}, {"tanh", tanh}, {"abs", fabs},
};

enum { FUNCTIONS = ARRAY_SIZE(functions) };

static bool is_taken(const char *name, const char *const *names, size_t count)
{
  for (size_t k = 0; k < count; k++)
    if (strcmp(names[k], name) == 0)
      return true;
  return false;
}

/* A variable with a function's name hides the function. */
static void define_functions(muParserHandle_t parser, const char *const *names, size_t count)
{
  mupClearFun(parser);
  mupClearConst(parser);
  for (size_t k = 0; k < FUNCTIONS; k++)
    if (!is_taken(functions[k].name, names, count))
      mupDefineFun1(parser, functions[k].name, functions[k].call, 1);
  if (!is_taken("pow", names, count))
    mupDefineFun2(parser, "pow", pow, 1);
  if (!is_taken("min", names, count))
    mupDefineMultFun(parser, "min", least, 1);
  if (!is_taken("max", names, count))
    mupDefineMultFun(parser, "max", most, 1);
  if (!is_taken("pi", names, count))
    mupDefineConst(parser, "pi", pi);
}

static bool is_letter(char c)
{
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_digit(char c)
{
  return c >= '0' && c <= '9';
}

static bool is_name(const char *word)
{
  if (!is_letter(*word) || strlen(word) >= NAME_LENGTH_MAX)
    return false;
  while (is_letter(*word) || is_digit(*word))
    word++;
  return *word == '\0';
}

/* Copies the text with line ends as blanks and refuses what muParser would take in another sense:
 * assignments, strings, and everything that is no ASCII. */
static bool copy_text(const char *text, char copy[TEXT_MAX], char *why, size_t size)
{
  size_t length = strlen(text);
  if (length >= TEXT_MAX) {
    snprintf(why, size, "the formula has %zu characters, at most %d are read", length,
             TEXT_MAX - 1);
    return false;
  }
  memcpy(copy, text, length + 1);
  for (size_t k = 0; k < length; k++) {
    char before = k > 0 ? copy[k - 1] : ' ';
    if (copy[k] == '\t' || copy[k] == '\n' || copy[k] == '\r')
      copy[k] = ' ';
    if (copy[k] == '=' && copy[k + 1] == '=')
      copy[++k] = '=';
    else if (copy[k] == '=' && before != '<' && before != '>' && before != '!') {
      snprintf(why, size, "'=' at column %zu: equality is written '=='", k + 1);
      return false;
    } else if (copy[k] < ' ' || copy[k] > '~' || strchr("\"#$';@[]\\`{}", copy[k]) != NULL) {
      snprintf(why, size, "a character that no formula has, at column %zu", k + 1);
      return false;
    }
  }
  if (copy[strspn(copy, " ")] == '\0') {
    snprintf(why, size, "the formula is empty");
    return false;
  }
  return true;
}

/* Appends to `why` as far as there is room. */
__attribute__((format(printf, 3, 4))) static void append(char *why, size_t size, const char *format,
                                                         ...)
{
  size_t length = strnlen(why, size);
  va_list arguments;
  va_start(arguments, format);
  if (length < size)
    vsnprintf(why + length, size - length, format, arguments);
  va_end(arguments);
}

/* Names all unknown names, each with the nearest known one; false if there are none. */
static bool name_unknown(muParserHandle_t parser, const char *const *names, size_t count, char *why,
                         size_t size)
{
  int total = mupGetExprVarNum(parser);
  bool found = false;
  if (mupError(parser))
    return false;
  for (int k = 0; k < total; k++) {
    const char *name = NULL;
    double *slot = NULL;
    mupGetExprVar(parser, (unsigned)k, &name, &slot);
    if (mupError(parser) || name == NULL || slot != NULL || !is_name(name))
      continue;
    append(why, size, "%s'%.60s'", found ? ", " : "unknown name ", name);
    const char *near = nearest(name, names, count);
    if (near != NULL)
      append(why, size, " (did you mean '%.60s'?)", near);
    found = true;
  }
  return found;
}

static bool is_function(const char *word)
{
  static const char *const others[] = {"pow", "min", "max"};
  for (size_t k = 0; k < FUNCTIONS; k++)
    if (strcmp(word, functions[k].name) == 0)
      return true;
  return is_taken(word, others, ARRAY_SIZE(others));
}

/* Puts muParser's error in plain words. It counts positions from 0 and has one buffer for all its
 * texts, so the token is copied first. */
static void explain(muParserHandle_t parser, const char *const *names, size_t count, char *why,
                    size_t size)
{
  enum { UNKNOWN_TOKEN = 1, UNEXPECTED_END = 2 };
  char token[61];
  int code = mupGetErrorCode(parser), column = mupGetErrorPos(parser) + 1;
  snprintf(token, sizeof token, "%s", mupGetErrorToken(parser));
  for (size_t end = strlen(token); end > 0 && token[end - 1] == ' ';)
    token[--end] = '\0';
  if (size > 0)
    why[0] = '\0';
  if (code == UNEXPECTED_END)
    append(why, size, "the formula ends too early");
  else if (code == UNKNOWN_TOKEN && is_function(token))
    append(why, size, "the function '%s' needs its arguments in brackets, at column %d", token,
           column);
  else if (name_unknown(parser, names, count, why, size))
    return;
  else if (code == UNKNOWN_TOKEN && is_name(token))
    append(why, size, "unknown name '%s' at column %d", token, column);
  else if (code == UNKNOWN_TOKEN)
    append(why, size, "'%s' at column %d is not understood", token, column);
  else
    append(why, size, "%s", mupGetErrorMsg(parser));
}

/* muParser calls this on errors; they are asked for after each call instead. */
static void ignore(muParserHandle_t parser)
{
  (void)parser;
}

/* Compiles by evaluating once: muParser finds errors only then. */
static bool compile(struct expression *expression, const char *text, const char *const *names,
                    char *why, size_t size)
{
  int results = 0;
  mupSetExpr(expression->parser, text);
  bool failed = mupError(expression->parser);
  if (!failed) {
    mupEvalMulti(expression->parser, &results);
    failed = mupError(expression->parser);
  }
  if (failed)
    explain(expression->parser, names, expression->count, why, size);
  else if (results != 1)
    snprintf(why, size, "this gives %d values, one is wanted (is a ',' meant to be a '.'?)",
             results);
  return !failed && results == 1;
}

/* Which slots the compiled formula reads. */
static void find_used(struct expression *expression)
{
  int total = mupGetExprVarNum(expression->parser);
  for (int k = 0; k < total; k++) {
    const char *name = NULL;
    double *slot = NULL;
    mupGetExprVar(expression->parser, (unsigned)k, &name, &slot);
    for (size_t j = 0; j < expression->count; j++)
      expression->used[j] = expression->used[j] || slot == &expression->slot[j];
  }
}

static void discard(struct expression *expression)
{
  if (expression == NULL)
    return;
  if (expression->parser != NULL)
    mupRelease(expression->parser);
  free(expression->slot);
  free(expression->used);
  free(expression);
}

static struct expression *make(const char *text, const char *const *names, size_t count, char *why,
                               size_t size)
{
  char copy[TEXT_MAX];
  if (!copy_text(text, copy, why, size))
    return NULL;
  struct expression *expression = calloc(1, sizeof *expression);
  if (expression == NULL)
    goto no_memory;
  expression->count = count;
  expression->slot = malloc((count + 1) * sizeof *expression->slot);
  expression->used = calloc(count + 1, sizeof *expression->used);
  expression->parser = mupCreate(muBASETYPE_FLOAT);
  if (expression->slot == NULL || expression->used == NULL || expression->parser == NULL)
    goto no_memory;
  mupSetErrorHandler(expression->parser, ignore);
  define_functions(expression->parser, names, count);
  for (size_t k = 0; k < count; k++) {
    expression->slot[k] = 1;
    if (is_name(names[k]))
      mupDefineVar(expression->parser, names[k], &expression->slot[k]);
  }
  if (!compile(expression, copy, names, why, size)) {
    discard(expression);
    return NULL;
  }
  find_used(expression);
  mupEval(expression->parser); /* translates the formula: later calls ask for no memory */
  return expression;
no_memory:
  snprintf(why, size, "no memory left for the formula");
  discard(expression);
  return NULL;
}

/* muParser makes and frees its parsers one at a time. */
struct expression *expression_new(const char *text, const char *const *names, size_t count,
                                  char *why, size_t size)
{
  EXCLUSIVE;
  return make(text, names, count, why, size);
}

void expression_free(struct expression *expression)
{
  EXCLUSIVE;
  discard(expression);
}

double expression_value(struct expression *expression, const double *value)
{
  if (expression->count > 0)
    memcpy(expression->slot, value, expression->count * sizeof *value);
  double result = mupEval(expression->parser);
  return mupError(expression->parser) ? NAN : result;
}

bool expression_uses(const struct expression *expression, size_t variable)
{
  return variable < expression->count && expression->used[variable];
}
