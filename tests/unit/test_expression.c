#include "expression/expression.h"

#include <locale.h>
#include <stdlib.h>

#include "tests/tap.h"

static const char *const names[] = {"x", "y", "T_melt", "e", "gamma-0", "C0"};
static const double values[] = {2, 3, 1356, 0.5, 7, 3940};
enum { COUNT = sizeof names / sizeof *names };

static void check(const char *text, double expected)
{
  char why[300] = "";
  struct expression *expression = expression_new(text, names, COUNT, why, sizeof why);
  double value = NAN;
  if (expression != NULL)
    value = expression_value(expression, values);
  else
    printf("# %s\n", why);
  tap_relative(text, value, expected, 1e-14);
  expression_free(expression);
}

static void refuse(const char *text, const char *part)
{
  char why[300] = "";
  struct expression *expression = expression_new(text, names, COUNT, why, sizeof why);
  bool found = expression == NULL && strstr(why, part) != NULL;
  tap_ok(found, "refused: '%.40s': %s", text, why);
  expression_free(expression);
}

static void test_values(void)
{
  check("x + y*2", 8);
  check("-x^2", -4);
  check("2^3^2", 512);
  check("2^-1 * +4", 2);
  check("sqrt(T_melt)", sqrt(1356));
  check("log(exp(2)) + log10(100)", 4);
  check("sin(pi/6)^2 + cos(pi/6)^2 + tan(0)", 1);
  check("asin(1) + acos(1) + atan(0)", asin(1));
  check("cosh(x)^2 - sinh(x)^2 + tanh(0)", pow(cosh(2), 2) - pow(sinh(2), 2));
  check("min(x, y, e) + max(x, y) + abs(-x) + pow(x, y)", 0.5 + 3 + 2 + 8);
  check("max(x)", 2);
  check("x < y", 1);
  check("x >= y", 0);
  check("(x == 2) + (y != 3) + (x <= 2) + (x > 5)", 2);
  check("x < 1 || y > 2 && e > 0", 1);
  check("x > 1 ? 10 : 20", 10);
  check("x > 5 ? 1 : y > 5 ? 2 : 3", 3);
  check("1e3 + 1.5E-1", 1000.15);
  check("  x\n  + y\t\r\n", 5);
  check("((((x))))", 2);
  check("e", 0.5);
}

static void test_refusals(void)
{
  refuse("", "empty");
  refuse(" \n", "empty");
  refuse("x + strengt", "unknown name 'strengt'");
  refuse("T_mlet - x", "'T_mlet' (did you mean 'T_melt'?)");
  refuse("foo + bar*foo", "unknown name 'bar', 'foo'");
  refuse("foo(3)", "unknown name 'foo' at column 1");
  refuse("x = 3", "'=='");
  refuse("x === 3", "'=='");
  refuse("x +", "ends too early");
  refuse("(x", "parenthesis");
  refuse("x)", "parenthesis");
  refuse("1, 2", "2 values");
  refuse("1,5 * x", "2 values");
  refuse("min()", "few");
  refuse("sin(1, 2)", "many");
  refuse("sin", "needs its arguments");
  refuse("sin x", "needs its arguments");
  refuse("2 3", "nexpected");
  refuse("3x", "nexpected");
  refuse("x ? 2", "");
  refuse("?:", "");
  refuse("1:2", "");
  refuse("!x", "not understood");
  refuse("1e999", "not understood");
  refuse("0x10", "unknown name 'x10'");
  refuse("_pi", "unknown name '_pi'");
  refuse("gamma-0", "unknown name 'gamma'");
  refuse("\"text\"", "column 1");
  refuse("x + \xC2\xB5", "column 5");
  refuse("x + \x01", "column 5");
  refuse("x; y", "column 2");
  refuse("%s%n", "");
  refuse("nan", "unknown name 'nan'");
}

/* `count` times `part`; the answer does not matter, coming back does. */
static void survive(const char *name, const char *head, const char *part, size_t count)
{
  size_t length = strlen(part);
  char *text = malloc(strlen(head) + count * length + 1);
  char *to = stpcpy(text, head);
  for (size_t k = 0; k < count; k++)
    to = stpcpy(to, part);
  char why[80] = "";
  struct expression *expression = expression_new(text, names, COUNT, why, sizeof why);
  tap_ok(expression != NULL || why[0] != '\0', "survives %s: %s", name, why);
  if (expression != NULL)
    expression_value(expression, values);
  expression_free(expression);
  free(text);
}

static void test_hostile(void)
{
  survive("1000 brackets", "", "(", 1000);
  survive("a million brackets", "", "(", 1000000);
  survive("many signs", "", "-", 1000);
  survive("many conditions", "", "x?", 500);
  survive("a long chain of conditions", "x", "?1:x", 240);
  survive("a long sum", "1", "+x", 490);
  survive("a long power", "x", "^x", 490);
  survive("a long name", "", "abcdefghij", 100);
  survive("a long operator", "x", "!", 999);
  survive("a long number", "", "1", 1000);
  survive("a name far too long", "", "abcdefghij", 400);
  survive("many unknown names", "1", "+a", 490);
  survive("many arguments", "max(1", ",x", 490);
  survive("deep functions", "", "sin(", 250);
  static const char letters[] = "xy1.e+-*/^()<>=&|?:, Tpimnax!";
  unsigned state = 1;
  int good = 0;
  for (int k = 0; k < 20000; k++) {
    char text[24], why[100];
    size_t length = 1 + (size_t)k % (sizeof text - 1);
    for (size_t j = 0; j < length; j++) {
      state = state * 1664525u + 1013904223u;
      text[j] = letters[(state >> 16) % (sizeof letters - 1)];
    }
    text[length < sizeof text ? length : sizeof text - 1] = '\0';
    struct expression *expression = expression_new(text, names, COUNT, why, sizeof why);
    if (expression != NULL)
      expression_value(expression, values);
    good += expression != NULL;
    expression_free(expression);
  }
  tap_ok(good > 0, "20000 texts of random letters, %d of them formulas", good);
}

int main(void)
{
  test_values();
  test_refusals();
  test_hostile();
  char why[100];
  struct expression *expression = expression_new("x + T_melt", names, COUNT, why, sizeof why);
  tap_ok(expression_uses(expression, 0) && expression_uses(expression, 2), "uses x and T_melt");
  tap_ok(!expression_uses(expression, 1) && !expression_uses(expression, 99), "uses nothing else");
  double other[COUNT] = {1, 0, 2, 0, 0, 0};
  tap_absolute("new values", expression_value(expression, other), 3, 0);
  other[0] = NAN;
  tap_ok(isnan(expression_value(expression, other)), "NaN goes through");
  expression_free(expression);
  expression = expression_new("1/0", NULL, 0, why, sizeof why);
  tap_ok(expression != NULL && isinf(expression_value(expression, NULL)), "1/0 is infinite");
  expression_free(expression);
  static const char *const shadow[] = {"min", "pi", "sin"};
  static const double shadow_value[] = {5, 6, 7};
  expression = expression_new("min + pi + sin", shadow, 3, why, sizeof why);
  tap_absolute("variables hide functions", expression_value(expression, shadow_value), 18, 0);
  expression_free(expression);
  char tiny[4];
  tap_ok(expression_new("unknown", names, COUNT, tiny, sizeof tiny) == NULL, "a tiny buffer: %s",
         tiny);
  if (setlocale(LC_ALL, "de_DE.UTF-8") != NULL)
    check("1.5 * 2", 3);
  return tap_done();
}
