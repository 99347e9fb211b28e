/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fields of tables as programs, spreadsheets and people write them, the lines that are left, and
 * numbers: each by hand. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "checks.h"
#include "orders/reading/reading.h"

/* A table and what it must give: the heading and each row in a line, with a bar behind each field;
 * then the lines that are left, "2 title". Or with a colon first, the refusal. */
static const struct {
    const char *text, *fields;
} tables[] = {
    /* separators, marks of decimals, quotes */
    {"h,l2\n1,3\n.5,2", "h|l2|\n1|3|\n.5|2|\n"},
    {"\ufeffh,l2\r\n1,3\r\n.5,2\r\n", "h|l2|\n1|3|\n.5|2|\n"},
    {"n\te\trate\n10\t1\t\n20\t.2\t2\n40\t.05\t2\n", "n|e|rate|\n10|1||\n20|.2|2|\n40|.05|2|\n"},
    {"h;e\n0,5;0,04\n0,25;0,01;\n", "h|e|\n0,5|0,04|\n0,25|0,01|\n"},
    {"h;e\n0,500;0,125\n0,250;0,031\n", "h|e|\n0,500|0,125|\n0,250|0,031|\n"},
    {"0,500;0,125\n0,250;0,031\n", "~|~|\n0,500|0,125|\n0,250|0,031|\n"},
    {"sep=;\nh;e\n0,5;0,04\n0,25;0,01\n", "h|e|\n0,5|0,04|\n0,25|0,01|\n"},
    {"0,5 2,5\n0,25 1,5\n", "~|~|\n0,5|2,5|\n0,25|1,5|\n"},
    {"\"n\",\"e\"\n\"8\",\"1,6\"\n\"16\",\"0,4\"\n", "n|e|\n8|1,6|\n16|0,4|\n"},
    {"h [mm],\"a\n\"\"b\"\", c\"\n1,4\n.5,2\n", "h [mm]|a\n\"b\", c|\n1|4|\n.5|2|\n"},
    {"N\u00a0 err\n1,000  1.5e-2\n2,000\u2009 3e-3\n", "N|err|\n1,000|1.5e-2|\n2,000|3e-3|\n"},
    {"N err\n10 1.0 x 10^-2\n20 2.5 x 10^-3\n", "N|err|\n10|1.0 x 10^-2|\n20|2.5 x 10^-3|\n"},
    {"N err\n10 1e-2 +- 1e-3\n20 2e-3 +- 1e-4\n", "N|err|\n10|1e-2 +- 1e-3|\n20|2e-3 +- 1e-4|\n"},
    {"mesh err\n[8 8] 0.1\n[16 16] 0.02\n", "mesh|err|\n[8 8]|0.1|\n[16 16]|0.02|\n"},
    {"mesh,err\n(8, 8),1\n(16, 16),2\n", "mesh|err|\n(8, 8)|1|\n(16, 16)|2|\n"},
    {"n=[8, 8] e=.1\nn=[16, 16] e=.02\n", "n|e|\n[8, 8]|.1|\n[16, 16]|.02|\n"},
    {"mesh err\n8 x 8 0.1\n16 x 16 0.02\n", "mesh|err|\n8 x 8|0.1|\n16 x 16|0.02|\n"},
    {"h,e\n.1,1 %\n.05,2 %\n", "h|e|\n.1|1 %|\n.05|2 %|\n"},
    {"h,e,why\n1,4,\n.5,1,\n", "h|e|why|\n1|4||\n.5|1||\n"},
    {"h,e\n1,4,\n.5,1,\n", "h|e|\n1|4|\n.5|1|\n"},
    {"\"h\u200b\",\"e\u00a0\u2009x\"\n1,4\n.5,1\n", "h\u200b|e\u00a0\u2009x|\n1|4|\n.5|1|\n"},
    /* bars, boxes, LaTeX */
    {"| h | L2 e |\n|:--|--:|\n| 1 | 4 |\n| .5 | 1 |\n", "h|L2 e|\n1|4|\n.5|1|\n"},
    {"N | e | rate\n--|---|---\n8 | 16 | -\n16 | 4 | 2\n", "N|e|rate|\n8|16|-|\n16|4|2|\n"},
    {"┌───┬────┐\n│ h │ e  │\n├───┼────┤\n│ 1 │ 16 │\n│.5 │ 4  │\n└───┴────┘\n",
     "h|e|\n1|16|\n.5|4|\n"},
    {"╔═══╦════╗\n║ h ║ e  ║\n╠═══╬════╣\n║ 1 ║ 16 ║\n║.5 ║ 4  ║\n╚═══╩════╝\n",
     "h|e|\n1|16|\n.5|4|\n"},
    {"┏━━━┳━━━━┓\n┃ h ┃ e  ┃\n┣━━━╋━━━━┫\n┃ 1 ┃ 16 ┃\n┃.5 ┃ 4  ┃\n┗━━━┻━━━━┛\n",
     "h|e|\n1|16|\n.5|4|\n"},
    {"╭───┬────╮\n┆ h ┆ e  ┆\n├───┼────┤\n┆ 1 ┆ 16 ┆\n┆.5 ┆ 4  ┆\n╰───┴────╯\n",
     "h|e|\n1|16|\n.5|4|\n"},
    {"┇ h ┇ e  ┇\n┊ 1 ┊ 16 ┊\n┋.5 ┋ 4  ┋\n", "h|e|\n1|16|\n.5|4|\n"},
    {"╎ h ╎ e  ╎\n╌╌╌╌╌╌╌╌╌╌\n╏ 1 ╏ 16 ╏\n╎.5 ╎ 4  ╎\n", "h|e|\n1|16|\n.5|4|\n"},
    {"Row │ N      L2\n    │ Int64  Float64\n────┼──\n  1 │   8  1.6\n  2 │  16  0.4\n",
     "Row|N|L2|\n1|8|1.6|\n2|16|0.4|\n"},
    {"\\hline\n$N$ & $e$ \\\\ \\hline\n10 & \\num{1e-2} \\\\ 20 & 2e-3 \\\\[2pt]\n\\end{tabular}\n",
     "$N$|$e$|\n10|\\num{1e-2}|\n20|2e-3|\n"},
    {" & \\multicolumn{2}{c}{P1} & \\multicolumn{2}{c}{P2} \\\\\n$N$ & e & EOC & e & EOC \\\\\n"
     "10 & 1 & -- & 2 & -- \\\\\n20 & .25 & 2 & .5 & 2 \\\\\n",
     "$N$|P1 e|P1 EOC|P2 e|P2 EOC|\n10|1|--|2|--|\n20|.25|2|.5|2|\n"},
    {" & \\multicolumn{2}c{P1} & \\multicolumn{2}{c}{P2} \\\\\n$N$ & e & EOC & f & EOC \\\\\n"
     "10 & 1 & -- & 2 & -- \\\\\n20 & .25 & 2 & .5 & 2 \\\\\n",
     "$N$|e|EOC|f|EOC|\n10|1|--|2|--|\n20|.25|2|.5|2|\n1 title\n"},
    {"ref | ||e|| | rate\n0 | 4 | -\n1 | 1 | 2\n", "ref|||e|||rate|\n0|4|-|\n1|1|2|\n"},
    {"|**N**|`e`|\n|8|**1**|\n|16||\n", "N|e|\n8|**1**|\n16||\n"},
    {"  n    e rate\n1  8  .1   NA\n2 16 .02  2.3\n", "~|n|e|rate|\n1|8|.1|NA|\n2|16|.02|2.3|\n"},
    {" Row │ n      e\n     │ Int64  Float64?\n─────┼──\n   1 │ 16  1.6\n   2 │ 32  0.4\n",
     "Row|n|e|\n1|16|1.6|\n2|32|0.4|\n"},
    {"4\u00d73 DataFrame\n Row │ n      l2       o\n     │ Int64  Float64  Float64?\n─────┼──\n"
     "   1 │    16  9.6e-4   missing\n   2 │    32  2.4e-4   2.0\n",
     "Row|n|l2|o|\n1|16|9.6e-4|missing|\n2|32|2.4e-4|2.0|\n1 title\n"},
    {"ref | ||u_h - u||_L2 | rate |\n0 | 4 | - |\n1 | 1 | 2 |\n",
     "ref|||u_h - u||_L2|rate|\n0|4|-|\n1|1|2|\n"},
    {"| h | ||u-u_h|| | ||Du-Du_h|| |\n|1|4|8|\n|.5|1|4|\n",
     "h|||u-u_h|||||Du-Du_h|||\n1|4|8|\n.5|1|4|\n"},
    {"h|||u-u_h||\n1|4\n.5|1\n", "h|||u-u_h|||\n1|4|\n.5|1|\n"},
    /* names */
    {"# N L2\n8 .04\n16 .01\n", "N|L2|\n8|.04|\n16|.01|\n"},
    {"# 1:h  2:e\n1 16\n.5 4\n", "h|e|\n1|16|\n.5|4|\n"},
    {"h=2.5E-01 E=1.3E-01 r=0.00\nh=1.2E-01 E=3.3E-02 r=1.98\n",
     "h|E|r|\n2.5E-01|1.3E-01|0.00|\n1.2E-01|3.3E-02|1.98|\n"},
    {" N=    7 err=  1e-2\n N= 1024 err= 4.7e-7\n", "N|err|\n7|1e-2|\n1024|4.7e-7|\n"},
    {"n = 10: error = 1e-2, order = -\nn = 20: error = 2e-3, order = 2.0\n",
     "n|error|order|\n10|1e-2|-|\n20|2e-3|2.0|\n"},
    {"step 1: n=10 L2 e=0,1\nstep 2: n=20 L2 e=0,02\n", "step|n|L2 e|\n1|10|0,1|\n2|20|0,02|\n"},
    {"h=0.1 m  e=0.2 m\nh=.05 m  e=.05 m\n", "h [m]|e [m]|\n0.1|0.2|\n.05|.05|\n"},
    {"step 3 n=10 e=1\nstep 4 n=20 e=.2\n", "step|n|e|\n3|10|1|\n4|20|.2|\n"},
    {"12:30:01 n: 8, e: .1\n12:30:09 n: 16, e: .02\n", "n|e|\n8|.1|\n16|.02|\n"},
    {"h & e \\\\\nh=1/2 & .1 \\\\\nh=1/4 & .02 \\\\\n", "h|e|\nh=1/2|.1|\nh=1/4|.02|\n"},
    {"n=8,e=,f=1\nn=16,e=(8, 8),f=\nn = 32 e = .1 f=.2\n",
     "n|e|f|\n8||1|\n16|(8, 8)||\n32|.1|.2|\n"},
    {"1 of 2: n=8 e=.1\n2 of 2: n=16 e=.02\n", "|of|n|e|\n1|2|8|.1|\n2|2|16|.02|\n"},
    {"10: e=0.1 r=2\n20: e=0.02 r=2\n", "|e|r|\n10|0.1|2|\n20|0.02|2|\n"},
    {"[5 May 10:30] n=10 e=1\n[5 May 10:31] n=20 e=.2\n", "n|e|\n10|1|\n20|.2|\n"},
    {"coarse mesh: n=10 e=1\nfine mesh: n=20 e=.2\n", "n|e|\n10|1|\n20|.2|\n"},
    {"N: 8, error: 1e-2\nN: 16, error: 2e-3\n", "N|error|\n8|1e-2|\n16|2e-3|\n"},
    {"8 1.6\n16 .4\n", "~|~|\n8|1.6|\n16|.4|\n"},
    {"p,1,2\n8,.1,.01\n16,.05,.0025\n32,.02,6e-4\n",
     "p|1|2|\n8|.1|.01|\n16|.05|.0025|\n32|.02|6e-4|\n"},
    {"   N   L2\n0  8  .04\n1  16 .01\n", "~|N|L2|\n0|8|.04|\n1|16|.01|\n"},
    {"     L2\nN\n8   .04\n16  .01\n", "N|L2|\n8|.04|\n16|.01|\n"},
    {"\"n\" \"e\"\n\"1\" 10 .1\n\"2\" 20 .02\n", "~|n|e|\n1|10|.1|\n2|20|.02|\n"},
    {"N L2 H1\n8 4 - 2 -\n16 1 2.0 1 1.0\n", "N|L2|~|H1|~|\n8|4|-|2|-|\n16|1|2.0|1|1.0|\n"},
    {"h,e\n[m],[-]\n.1,1\n.05,.2\n", "h [m]|e [-]|\n.1|1|\n.05|.2|\n"},
    {"rho    v\ne  EOC  e  EOC\n4  -  8  -\n1  2.0  2  2.0\n\nmean  2.0  mean  2.0\n",
     "rho e|rho EOC|v e|v EOC|\n4|-|8|-|\n1|2.0|2|2.0|\n6 summary\n"},
    {",P1,,P2,\nN,e,rate,e,rate\n8,.1,,.01,\n16,.05,1,.002,2\n",
     "N|P1 e|P1 rate|P2 e|P2 rate|\n8|.1||.01||\n16|.05|1|.002|2|\n"},
    /* gaps */
    {"N error rate\n10 1e-2\n20 2e-3 2.0\n40 6e-4 2.0\n",
     "N|error|rate|\n10|1e-2||\n20|2e-3|2.0|\n40|6e-4|2.0|\n"},
    {"N a rate b rate\n10 1 2\n20 .2 2.0 1 1.0\n40 .1 1.0 .5 1.0\n",
     "N|a|rate|b|rate|\n10|1||2||\n20|.2|2.0|1|1.0|\n40|.1|1.0|.5|1.0|\n"},
    {"N e\n10 1\n20 .2 2.0\n40 .05 2.0\n", "N|e|~|\n10|1||\n20|.2|2.0|\n40|.05|2.0|\n"},
    {"N,e\n8,1,\n16,.2,2\n32,.05,2\n", "N|e|~|\n8|1||\n16|.2|2|\n32|.05|2|\n"},
    {"N,e,EOC\n8,1\n16,.2,2\n32,.05,2\n", "N|e|EOC|\n8|1||\n16|.2|2|\n32|.05|2|\n"},
    {"p,n,e\nP1,8,1\nP1,16,.2\n\nP2,8,2\n", "p|n|e|\nP1|8|1|\nP1|16|.2|\nP2|8|2|\n"},
    {"2 8 1\n2 16 .2\n\n2 32 .05\n", "~|~|~|\n2|8|1|\n2|16|.2|\n2|32|.05|\n"},
    {"n,e\nnan,nan\n10,1\n,\n20,.2\n,,\n", "n|e|\nnan|nan|\n10|1|\n20|.2|\n"},
    /* lines that are left */
    {"Results, run of today\nN error\n10 1e-2\n20 2e-3\n",
     "N|error|\n10|1e-2|\n20|2e-3|\n1 title\n"},
    {"Convergence study, 2026\nh,e\n1,16\n.5,4\n", "h|e|\n1|16|\n.5|4|\n1 title\n"},
    {"l2\nscalar\nN e EOC\n8 1 -\n16 .2 2.0\n", "N|e|EOC|\n8|1|-|\n16|.2|2.0|\n1 title\n2 title\n"},
    {"# run 7\nh,e\n# fine\n1,16\n.5,4\n#\n", "h|e|\n1|16|\n.5|4|\n"},
    {"h,e\n1,16\n# so far\n#.7,8\n.5,4\n# end\n",
     "h|e|\n1|16|\n.5|4|\n3 comment\n4 comment\n6 comment\n"},
    {"# name: A\n# columns: 2\n1 16\n.5 4\n", "~|~|\n1|16|\n.5|4|\n"},
    {"|N|e|EOC|\n|8|1|-|\n|16|.2|2.0|\n|Overall|---|2.0|\n",
     "N|e|EOC|\n8|1|-|\n16|.2|2.0|\n4 summary\n"},
    {"N e EOC\n8 1 -\n16 .2 2.0\nOverall EOC is 2.0\n", "N|e|EOC|\n8|1|-|\n16|.2|2.0|\n4 footer\n"},
    {"n,e\n10,1\n20,.2\n40,.04\nall is well\n", "n|e|\n10|1|\n20|.2|\n40|.04|\n5 footer\n"},
    {"n e\n10 1\n20 .2\n40 .04\nOverall 2.0\n", "n|e|\n10|1|\n20|.2|\n40|.04|\n5 summary\n"},
    {"n,e\n10,1\n20,.2\nmean,3e-3\nstd,1\n", "n|e|\n10|1|\n20|.2|\n4 summary\n5 summary\n"},
    {"n,e\n10,1\n20,.2\nmean,15,.6\n", "n|e|\n10|1|\n20|.2|\n4 footer\n"},
    {"n,e\n10,1\n20,.2\nmean,15,.6\nmax,20,1\n", ":t:5: found 'max,20,1' between or beside"},
    {"n,e\n10,1\nmean,.2\n20,3e-3\n", "n|e|\n10|1|\nmean|.2|\n20|3e-3|\n"}, /* not the last */
    {"n e\n10 1 # a\n20 .2\n40 .1 # b", "n|e|\n10|1|\n20|.2|\n40|.1|\n2 comment\n4 comment\n"},
    {"n = 8 e = 1 #a\nn = 16 e = .2\n", "n|e|\n8|1|\n16|.2|\n1 comment\n"},
    {"N, # dofs, e\n8,64,1\n16,256,.2\n", "N|# dofs|e|\n8|64|1|\n16|256|.2|\n"},
    {"n e\n8 1\nit took 3 s\n16 .2\nit took 9 s\n32 .1\n",
     "n|e|\n8|1|\n16|.2|\n32|.1|\n3 between rows\n5 between rows\n"},
    {"n e\n8 1\n16 .2\nP2 of all\n32 2\n64 1\n",
     ":t:4: found 'P2 of all' between or beside the rows of lines 2 to 3"},
    {"A = [\n8 1.6\n16 .4\n];\n", "~|~|\n8|1.6|\n16|.4|\n1 title\n4 footer\n"},
    /* JSON */
    {"[{\"h\":0.1,\"e\":1e-2},{\"h\":0.05,\"e\":NaN}]", "h|e|\n0.1|1e-2|\n0.05|NaN|\n"},
    {"{\"h\":0.1,\"e\":{\"l2\":1}}\n{\"h\":0.05,\"e\":{\"l2\":\"x\"}}\n",
     "h|e l2|\n0.1|1|\n0.05|x|\n"},
    {"{\"h\":[0.1,0.05],\"e\":[1,2],\"p\":3}", "h|e|\n0.1|1|\n0.05|2|\n0 beside the table\n"},
    {"{\"h\":{\"0\":0.1,\"1\":0.05},\"e\":{\"0\":1,\"1\":2}}", "h|e|\n0.1|1|\n0.05|2|\n"},
    {"{\"l2\":{\"8\":0.1,\"16\":0.05},\"h1\":{\"8\":1,\"16\":2}}",
     "~|l2|h1|\n8|0.1|1|\n16|0.05|2|\n"},
    {"{\"8\":{\"l2\":0.1},\"16\":{\"l2\":0.05}}", "~|l2|\n8|0.1|\n16|0.05|\n"},
    {"{\"columns\":[\"h\",\"e\"],\"index\":[0,1],\"data\":[[0.1,1],[0.05,null]]}",
     "h|e|\n0.1|1|\n0.05||\n"},
    {"{\"schema\":{\"fields\":[{\"name\":\"h\",\"type\":\"number\"},"
     "{\"name\":\"t\",\"type\":\"datetime\"}]},\"data\":[{\"h\":0.1,\"t\":\"2026\"}]}",
     "h|t: words|\n0.1|2026|\n"},
    {"{\"runs\":[{\"n\":10,\"e\":1,\"ok\":true}],\"title\":\"a\"}",
     "n|e|ok|\n10|1|true|\n0 beside the table\n"},
    {"{\"set\":{\"a\":1},\"runs\":{\"h\":[0.1,0.05],\"e\":[1,2]}}",
     "h|e|\n0.1|1|\n0.05|2|\n0 beside the table\n"},
    {"[[\"h\",\"e\"],[0.1,1],[0.05,2]]", "h|e|\n0.1|1|\n0.05|2|\n"},
    {"{\"columns\":[\"e\",\"r\"],\"index\":[8,16],\"data\":[[1,2],[0.2,3]]}",
     "~|e|r|\n8|1|2|\n16|0.2|3|\n"},
    {"{\"ns\":[1,2],\"runs\":[{\"h\":1,\"e\":[1,2]}]}", "h|e 1|e 2|\n1|1|2|\n0 beside the table\n"},
    {"[{\"\":8,\"e\":1},{\"\":16,\"e\":2}]", "~|e|\n8|1|\n16|2|\n"},
    {"[[1,2],[3,4]]", "1|2|\n1|2|\n3|4|\n"},
    /* refusals */
    {"[[1,2],[3],[4,5]]", ":t: found rows of several lengths"},
    {"[[\"a\",\"a\"],[3,4]]", ":t: found two values of a row of a"},
    {"", ":t:1: the table is empty"},
    {"# nothing\n\n", ":t:1: the table is empty"},
    {"n,e\n10,1\n20,0.25\n40,0.0625\n80,\"", ":t:5: a quote is never closed"},
    {"h,l2\n1,\"3\"1\n.5,2\n", ":t:2: found text behind a quote in its field"},
    {"h l2\n1 3\n.5 2 7\n", ":t:3: found more than the 2 fields of the heading"},
    {"h l2\n1 3\n.5 2 7\n.2 1\n", ":t:3: found more than the 2 fields of the heading"},
    {"h,l2\n1,3,4\n", ":t:2: found more than the 2 fields of the heading"},
    {"h,l2\n1,3\n\n2\n", ":t:4: found fewer than the 2 fields of the heading"},
    {"h,a,b\n1,3,4\n.5,2\n.2,1,1\n", ":t:3: found fewer than the 3 fields of the heading"},
    {"h=1 l2=3\nh=.5 l1=2\n", ":t:2: found 'l1=2', expected 'l2 = ...'"},
    {"h;l2\n0,5;1.000,5\n0,25;2\n", ":t:2: found '1.000,5' beside numbers with ','"},
    {"n;e\n1.000;0,4\n2.000;0,1\n500;1\n", "n|e|\n1.000|0,4|\n2.000|0,1|\n500|1|\n"},
    {"h;l2\n1.000;0,4\n2,5;0,1\n", ":t:2: found '1.000' beside numbers with ','"},
    {"h;l2\n1.000;0,4\n0.500;0,1\n", ":t:3: found '0.500' beside numbers with ','"},
    {"h;l2\n1,024;1\n2,048;2\n", ":t:2: each comma stands before three digits"},
    {"n e\n8 1\n16 .2\n\nn e\n8 2\n16 1\n",
     ":t:5: found 'n e' between or beside the rows of lines 2 to 3"},
    {"n e\n8 1\nfailed\n16 .2\n",
     ":t:3: found 'failed' between or beside the rows of lines 2 to 2"},
    {"8 1\n16 .2\n\n\n8 2\n16 1\n", ":t:5: the rows begin again as on line 1"},
    {"n,e\n8,1\n16,.2\n# P2\n8,2\n", ":t:5: the rows begin again as on line 2"},
    {"Error for n=10 is 0.1\nError for n=20 is 0.02\n", "n|Error|\n10|0.1|\n20|0.02|\n"},
    {"error in n=0.1 at h=1\nerror in n=0.02 at h=2\n", "error in n|h|\n0.1|1|\n0.02|2|\n"},
    {"iterations n=3, e=1\niterations n=5, e=2\n", "iterations n|e|\n3|1|\n5|2|\n"},
    {"On N = 8 the H1 error is 1 and the L2 error was .1\nOn N = 16 the H1 error is .5 and the L2 error "
     "was .02\n",
     "N|H1 error|L2 error|\n8|1|.1|\n16|.5|.02|\n"},
    {"N = 8: e 2 x 10^-2\nN = 16: e 5 x 10^-3\n", "N|e|\n8|2 x 10^-2|\n16|5 x 10^-3|\n"},
    {"N = 8: e 2 e-2\nN = 16: e 5 e-3\n", ":t:1: found no row of numbers"},
    {"N=8, e=2 e-2\nN=16, e=5 e-3\n", ":t:1: found no row of numbers"},
    {"h = 2 m, e = 1\nh = 1 m, e = 2\n", "h [m]|e|\n2|1|\n1|2|\n"},
    {"h = 1 m, e = 1\nh = 500 mm, e = 2\n", ":t:2: found 'h [mm]=500', expected 'h [m] = ...'"},
    {"N = 8: e 2 mm\nN = 16: e 5 um\n", ":t:2: found 'e [um]=5', expected 'e [mm] = ...'"},
    {"n e\n8 1\n16 .2\n2 of 2 done\n", "n|e|\n8|1|\n16|.2|\n4 footer\n"},
    {"N=8 e=1\nN=16 e=.2\nRun N=32: failed\n", "N|e|\n8|1|\n16|.2|\n32||\n"},
    {"N=8, e=1\nN=16, e=.2\nN = 32: diverged after 3 steps\n", "N|e|\n8|1|\n16|.2|\n32||\n"},
    {"n e\n8 1\n16 .2\nn=32 failed\n", "n|e|\n8|1|\n16|.2|\n32||\n"},
    {"N=8, e=1\nN=16, e=.2\nOverall 2.0 of 2 meshes\n", "N|e|\n8|1|\n16|.2|\n3 footer\n"},
    {"See 4 for h=1: 5\nSo 2 of h=3: 7\n", "~|~|~|~|~|\nSee|4|for|h=1:|5|\nSo|2|of|h=3:|7|\n"},
    {"[a] 2024-03-01 12:00:01 step size 0.1 error 3\n[b] 2024-03-01 12:00:02 step size 0.05 error 1",
     "step size|error|\n0.1|3|\n0.05|1|\n"},
    {"Version 1.3\nWith N = 8: error 0.1\nWith N = 16: error 0.02\nIn 3 s\n",
     "N|error|\n8|0.1|\n16|0.02|\n1 title\n4 footer\n"},
    /* sizes and errors on lines of their own */
    {"v 1\nOn h = .2:\nmesh made\nL2 error: .4\nOn h = .1:\nmesh made\nL2 error: .1\nOn h = .05:\n"
     "mesh made\nL2 error: .03\nOn h = .02:\nkilled\nall in 9 s\n",
     "h|L2 error|\n.2|.4|\n.1|.1|\n.05|.03|\n.02||\n1 title\n3 between rows\n6 between rows\n"
     "9 between rows\n12 footer\n13 footer\n"},
    {"On N = 8\nNewton 1 left 3\nNewton 2 left .1\nL2 .4\nOn N = 16\nNewton 1 left 2\nL2 .1\n",
     "N|L2|\n8|.4|\n16|.1|\n2 comment\n3 comment\n6 comment\n"},
    {"- N: 8\n  steps: 3\n  err: .1\n- N: 16\n  steps: 6\n  err: .02\n",
     "N|steps|err|\n8|3|.1|\n16|6|.02|\n"},
    {"[1:02] n = 8\nits 3\nits 4\n[1:03] error = .1\n[1:04] n = 16\nits 3\n[1:05] error = .02\n",
     "n|error|\n8|.1|\n16|.02|\n2 comment\n3 comment\n6 comment\n"},
    {"error: .1\nh = .2\nerror: .02\nh = .1\nerror: .004\nh = .05\n",
     ":t:3: found 'error: .02' between or beside the rows of lines 2 to 2"},
    {"h = .2\nReference h = .1\nerror: .1\nh = .1\nReference h = .05\nerror: .02\n",
     ":t:3: found 'error: .1' between or beside the rows of lines 1 to 2"},
    {"N = 8 (l2 is 0.3), h1 is 2.\nN = 16 (l2 is nan), h1 is 1.\n",
     "N|l2|h1|\n8|0.3|2|\n16|nan|1|\n"},
    {"With N = 8: error 0.1\nWith N = 16: error 0.02\nWith N = 32: it diverged\n",
     "N|error|\n8|0.1|\n16|0.02|\n32||\n"},
    {"N=8 e=1\nN=16 e=.2\nN=32 e=.1N=64 e=.02\n", ":t:3: found 'N=32 e=.1N=64 e=.02', expected a"},
    {"N = 8: e .1\nN = 16: e .02\nN = 32: e .01 most .3\n",
     ":t:3: found 'N = 32: e .01 most .3', exp"},
    {"n=8 e=1\nn=16 e=.2\nn=32 e=5;3e-2\n", ":t:3: found 'n=32 e=5;3e-2', expected a row"},
    {"n = 8: err .1\nn = 16: err .02\nn = 32: err 1.-3\n", ":t:3: found 'n = 32: err 1.-3', exp"},
    {"N=8 begins\nN=8 e=0.1\nN=16 e=0.02\nN=32 failed\n",
     "N|e|\n8|0.1|\n16|0.02|\n32||\n1 title\n"},
    {"N e\n8 0.1\n16 0.02\n32 it diverged\n", "N|e|\n8|0.1|\n16|0.02|\n32||\n"},
    {"N e\n8 0.1\n16 0.02\n32 went wrong\n",
     ":t:4: found '32 went wrong', expected a row of 2 fields"},
    {"N e\n8 .1\n16 .02\n# 32 failed\n# 9 of 10 failed\n# 64 cores\n",
     "N|e|\n8|.1|\n16|.02|\n32||\n5 comment\n6 comment\n"},
    {"# 4 failed\nN,e\n8,.1\n# 12 failed\n16,.02\n24 failed\n",
     "N|e|\n8|.1|\n12||\n16|.02|\n24||\n"},
    {"level e f\n2 .1 1\n3 .02 2\nlevel 4 crashed\nLevels above 6 crashed, too\n",
     "level|e|f|\n2|.1|1|\n3|.02|2|\n4|||\n5 footer\n"},
    {"n e\n8 .1\n16 .02\nSegmentation fault\n", ":t:4: found 'Segmentation fault', expected a row"},
    {"n e\n8 .1\n16 .02\n\nError: not converged\n", ":t:5: found 'Error: not converged', expected"},
    {"n e\n8 .1\n16 .02\nh = .03 failed\n", ":t:4: found 'h = .03 failed', expected a row of 2"},
    {"h [m],e\n2,4\n1,2\nh = .5 failed\n", "h [m]|e|\n2|4|\n1|2|\n.5||\n"},
    {"n e\n8 .1\n16 .02\nRunning n=32\nSegmentation fault\n",
     "n|e|\n8|.1|\n16|.02|\n32||\n5 footer\n"},
    {"Finer is N=64\nN=8 e=1\nN=16 e=.2\nRunning N=32\nCommand terminated\n",
     "N|e|\n8|1|\n16|.2|\n32||\n1 title\n5 footer\n"},
    {"N=8 run=1 e=1\nN=8 run=2 e=.9\nN=16 run=1 e=.2\nN=16 run=2: no convergence\n",
     "N|run|e|\n8|1|1|\n8|2|.9|\n16|1|.2|\n16|2||\n"},
    {"Mesh 1 (h = .5): e .1\nMesh 2 (h = .25): e .03\nMesh 3 (h = .125): no convergence\n",
     "Mesh|h|e|\n1|.5|.1|\n2|.25|.03|\n3|.125||\n"},
    {"m N e\nA 8 0.1\nB 16 0.02\nC 32: no memory left\n", "m|N|e|\nA|8|0.1|\nB|16|0.02|\nC|32||\n"},
    {"m N e\nA 8 0.1\nB 16 0.02\nTotal 32 s used\n", "m|N|e|\nA|8|0.1|\nB|16|0.02|\n4 footer\n"},
    {"h e\n.2 0.1\n.1 0.02\n0 errors were found\n", "h|e|\n.2|0.1|\n.1|0.02|\n4 footer\n"},
    {"N=8 e=1 f=2\nN=16 e=.2 f=.5\nN=32 e=.1\n", "N|e|f|\n8|1|2|\n16|.2|.5|\n32|.1||\n"},
    {"N e f\n8 1 2\n16 .2 .5\n32 .1 .2 more\n", ":t:4: found '32 .1 .2 more', expected a row of 3"},
    {"N e\n8 0.1\n16 0.02\n4 tests passed\n", "N|e|\n8|0.1|\n16|0.02|\n4 footer\n"},
    {"h,1/2,1/4,1/8\nL2,3,2,1\nrate,,1,1\n", "h|L2|rate|\n1/2|3||\n1/4|2|1|\n1/8|1|1|\n"},
    {"a,1/2,1/4,1/8\nL2,3,2,1\n", "~|~|~|~|\na|1/2|1/4|1/8|\nL2|3|2|1|\n"},
    {"h,1/2,1/4,1/8\nP1,3,2,1\n", "h|P1|\n1/2|3|\n1/4|2|\n1/8|1|\n"},
    {"h,3,1,.2\np,4,2,1\nhp,2,1,.4\n", "~|~|~|~|\nh|3|1|.2|\np|4|2|1|\nhp|2|1|.4|\n"},
    {"case,4,8,16\nh,3,1,.2\np,4,2,1\n", "~|~|~|~|\ncase|4|8|16|\nh|3|1|.2|\np|4|2|1|\n"},
    {"h,8,4,2\nh,16,2,1\nL2,8,1,.2\n", "~|~|~|~|\nh|8|4|2|\nh|16|2|1|\nL2|8|1|.2|\n"},
    {"h,1,.2\nL2,.5,.1\n", "~|~|~|\nh|1|.2|\nL2|.5|.1|\n"},
    {"h,1/2,1/4,1/8\nL2,3,2,some\n", "~|~|~|~|\nh|1/2|1/4|1/8|\nL2|3|2|some|\n"},
    {"n,e,,n,e\n8,1,,8,2\n16,.2,,16,1\n", ":t:1: found an empty column 3 between others"},
    {"{\"a\":[{\"h\":1}],\"b\":[{\"h\":2}]}", ":t: found several tables"},
    {"{\"a\":{\"0\":1,\"1\":2},\"b\":{\"1\":1,\"0\":2}}", ":t: found columns with other rows"},
    {"{\"a\":[1,2],\"b\":[1]}", ":t: found 2 values, but 1 of b"},
    {"{\"h\":0.1,\"e\":0.01}", ":t: found a single record"},
    {"{\"a\":\n [1,}", ":t:2: found no valid JSON"},
    {"{\"h\":1}\n{\"h\":}\n", ":t:2: found no valid JSON"},
    {"{\"h\":1}\n{\"h\":NaN}\n{\"h\":}\n", ":t:2: found no valid JSON"},
    {"h = [1,2,3]\ne = [4 5 6];\n", "h|e|\n1|4|\n2|5|\n3|6|\n"},
    {"h = [1,2,3]\ne = [4,5,6]\ne[0] /= 2\n",
     ":t:3: found a line that changes the list 'e' of line 2"},
    {"h: [1,2,3], e: [4,5,6]\nh: [1,2,3], e: [7,8,9]\n",
     ":t:2: found a line that changes the list 'h' of line 1"},
    {"h = [1,2,3]\ne = [4,5,6,7]\n", ":t: found 4 values, but 3 of h"},
    {"<tr><th>h<th>e<tr><td rowspan=2>1<td>4<tr><td>5<tr><td>6<td>7", "h|e|\n1|4|\n1|5|\n6|7|\n"},
    /* names of words above their columns */
    {"Cycle Mesh size    L2-Error\n    0    0.3025 1.24e-04    -\n    1    0.1513 9.65e-06 3.7\n",
     "Cycle|Mesh size|L2-Error|~|\n0|0.3025|1.24e-04|-|\n1|0.1513|9.65e-06|3.7|\n"},
    {"n  L2 error  H(curl) error\n8  1.21e-02  1.0e-01\n16 3.02e-03  5.0e-02\n",
     "n|L2 error|H(curl) error|\n8|1.21e-02|1.0e-01|\n16|3.02e-03|5.0e-02|\n"},
    {"#   Mesh size  L2 error\n#      0.3025  1.24e-04    -\n#      0.1513  9.65e-06  3.7\n",
     "Mesh size|L2 error|~|\n0.3025|1.24e-04|-|\n0.1513|9.65e-06|3.7|\n"},
    {"N err  rate\n1000 1.0e-2 -\n2000 2.5e-3 2.0\n",
     "N|err|rate|\n1000|1.0e-2|-|\n2000|2.5e-3|2.0|\n"},
    {"h L2 error\n0.1 1e-2\n0.05 2e-3\n", ":t:2: found fewer than the 3 fields of the heading"},
    {"h  a b\n0.1  1e-2\n0.05    2e-3\n", "h|a b|\n0.1|1e-2|\n0.05|2e-3|\n"},
    {"h  a  b\n0.1  1e-2\n0.05    2e-3\n", ":t:2: found fewer than the 3 fields of the heading"},
    /* names and numbers in turn, the name of a log */
    {"Euler\ndt 0.2  error 0.4  rate 1\ndt 0.1  error 0.2  rate 1\n",
     "dt|error|rate|\n0.2|0.4|1|\n0.1|0.2|1|\n1 title\n"},
    {"P1 8 fine 0.1\nP2 16 fine 0.02\n", "~|~|~|~|\nP1|8|fine|0.1|\nP2|16|fine|0.02|\n"},
    {"DEAL::n e\nDEAL::8 1\nDEAL:2d::16 .2\nDEAL::\n", "n|e|\n8|1|\n16|.2|\n"},
};

static void add_rows(char *text, size_t size, const struct br_fields *f)
{
    for (size_t i = 0; i < f->columns; i++)
        br_append(text, size, "%s%s|", f->heading[i] ? f->heading[i] : "~",
                  f->is_words[i] ? ": words" : "");
    br_append(text, size, "\n");
    for (size_t i = 0; i < f->rows * f->columns; i++)
        br_append(text, size, "%s|%s", f->field[i] ? f->field[i] : "",
                  (i + 1) % f->columns ? "" : "\n");
    for (size_t i = 0; i < f->lefts; i++)
        br_append(text, size, "%zu %s\n", f->left[i].line, f->left[i].why);
}

TEST(test_tables)
{
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        const char *wanted = tables[i].fields;
        char found[1100] = "";
        OWNED(br_fields) fields;
        struct br_error why = {0};
        FREED char *text = strdup(tables[i].text); /* its end is the end of the memory */
        assert_non_null(text);
        if (br_fields_read(text, "t", NULL, &fields, &why))
            snprintf(found, sizeof found, ":%s", why.message);
        else
            add_rows(found, sizeof found, &fields);
        if (*wanted == ':' ? strncmp(found, wanted, strlen(wanted)) : strcmp(found, wanted))
            fail_msg("of:\n%s\nfound:\n%s\nexpected:\n%s", tables[i].text, found, wanted);
    }
}

/* NaN: it is no number. */
static const struct {
    const char *text;
    char mark;
    double value, deviation;
} numbers[] = {
    {"-1.5D-3", '.', -1.5e-3, NAN},
    {"0.25-103", '.', 0.25e-103, NAN},
    {"1.5-003", '.', 1.5e-3, NAN},
    {"~0.04", '.', 0.04, NAN},
    {"~", '.', NAN, NAN},
    {"2.q+2", '.', 200, NAN},
    {"1,5e-3", ',', 1.5e-3, NAN},
    {"\u22121.5", '.', -1.5, NAN},
    {"1.0\u00b710\u207b\u00b3", '.', 1e-3, NAN},
    {"1.0 x 10^-2", '.', 1e-2, NAN},
    {"$-1.5 \\times 10^{-3}$", '.', -1.5e-3, NAN},
    {"\\num{1.2e-2}", '.', 1.2e-2, NAN},
    {"\\textbf{7}", '.', 7, NAN},
    {"**7**", '.', 7, NAN},
    {"`7`", '.', 7, NAN},
    {"1,000", '.', 1000, NAN},
    {"12,345,678", '.', 12345678, NAN},
    {"3/8", '.', 0.375, NAN},
    {"2^-4", '.', 0.0625, NAN},
    {"10^-3", '.', 1e-3, NAN},
    {"8x8x8", '.', 8, NAN},
    {"[128,128]", '.', 128, NAN},
    {"(16, 16, 16)", '.', 16, NAN},
    {"[ 8 8 ]", ',', 8, NAN},
    {"[8 16]", '.', NAN, NAN},
    {"[8]", '.', NAN, NAN},
    {"[8 8", '.', NAN, NAN},
    {"[8 8] 8", '.', NAN, NAN},
    {"32\u00d732", '.', 32, NAN},
    {"5 %", '.', 0.05, NAN},
    {"5\\%", '.', 0.05, NAN},
    {"1.2e-2 +- 1e-3", '.', 1.2e-2, 1e-3},
    {"1.5 \u00b1 0.25", '.', 1.5, 0.25},
    {"1.5(2)", '.', 1.5, 0.2},
    {"1.5(-2)", '.', 1.5e-2, NAN},
    {"1.5(\u22122)", '.', 1.5e-2, NAN},
    {"1.5(+2)", '.', 150, NAN},
    {"1.5(-0.2)", '.', NAN, NAN},
    {"pi/8", '.', 0.39269908169872414, NAN},
    {"$2\\pi/16$", '.', 0.39269908169872414, NAN},
    {"2*\u03c0", '.', 6.283185307179586, NAN},
    {"pipe", '.', NAN, NAN},
    {"1.5(0.25)", '.', 1.5, 0.25},
    {"6.25(12)e-4", '.', 6.25e-4, 12e-6},
    {"$6.25(12)\\times 10^{-4}$", '.', 6.25e-4, 12e-6},
    {"1,00", '.', NAN, NAN},
    {"1.0000000000000000000000000000000000000000000000000000000000000000000000000005e-3", '.', 1e-3,
     NAN},
    {"8x16", '.', NAN, NAN},
    {"8x8x", '.', NAN, NAN},
    {"8x8x9", '.', NAN, NAN},
    {"48x8", '.', NAN, NAN},
    {"1/0", '.', NAN, NAN},
    {"1/2/3", '.', NAN, NAN},
    {"5 % x", '.', NAN, NAN},
    {"1-2-3", '.', NAN, NAN},
    {"2026-05", '.', NAN, NAN},
    {"2026-05-01", '.', NAN, NAN},
    {"12:30", '.', NAN, NAN},
    {"1.2.3", '.', NAN, NAN},
    {"1.5-03", '.', NAN, NAN},
    {"15-003", '.', NAN, NAN},
    {"2^-3000", '.', NAN, NAN},
    {"1e999", '.', NAN, NAN},
    {"1e-400", '.', NAN, NAN},
    {"1 2", '.', NAN, NAN},
    {"0,125", '.', NAN, NAN},
    {"1,0000", '.', NAN, NAN},
    {"1.000", ',', 1000, NAN},
    {"1.000.000", ',', 1e6, NAN},
    {"0.500", ',', NAN, NAN},
    {"1.00", ',', NAN, NAN},
    {"1.000,5", ',', NAN, NAN},
    {"d5", '.', NAN, NAN},
    {"0x10", '.', NAN, NAN},
    {".", '.', NAN, NAN},
    {"e5", '.', NAN, NAN},
    {"+-1", '.', NAN, NAN},
    {"1.5D", '.', NAN, NAN},
    {"", '.', NAN, NAN},
};

static bool same(double found, double wanted)
{
    return isnan(wanted) ? isnan(found) : fabs(found - wanted) <= 4e-16 * fabs(wanted);
}

TEST(test_numbers)
{
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        struct br_field_number found;
        const bool is_number = br_field_read(numbers[i].text, numbers[i].mark, &found);
        if (is_number == isnan(numbers[i].value) ||
            (is_number &&
             !(same(found.value, numbers[i].value) && same(found.deviation, numbers[i].deviation))))
            fail_msg("'%s': found %d: %.17g +- %g, expected %.17g +- %g", numbers[i].text,
                     is_number, found.value, found.deviation, numbers[i].value,
                     numbers[i].deviation);
    }
}

/* Each upright line of a box is a bar, and each level one none. */
TEST(test_boxes)
{
    static const char *const bars[] = {"\u2502", "\u2503", "\u2506", "\u2507", "\u250a",
                                       "\u250b", "\u254e", "\u254f", "\u2551"};
    for (size_t i = 0; i < sizeof bars / sizeof *bars; i++) {
        const char *const b = bars[i];
        char text[200];
        OWNED(br_fields) f;
        snprintf(text, sizeof text, "%sn%se%s\n\u2550\u2550\u2500\n%s10%s1%s\n%s20%s.2%s\n", b, b,
                 b, b, b, b, b, b, b);
        MUST(br_fields_read(text, "t", NULL, &f, &err));
        assert_int_equal(f.columns, 2);
        assert_int_equal(f.rows, 2);
        assert_string_equal(f.heading[0], "n");
        assert_string_equal(f.field[3], ".2");
        assert_int_equal(f.lefts, 0);
    }
}

TEST(test_missing)
{
    static const char *const missing[] = {
        NULL,      "",     "-",    "--",       "---",       "\u2013", "\u2014",   "\u2212",
        "NaN",     "-nan", "+nan", "NA",       "N/A",       "n.a.",   "#N/A",     "None",
        "inf",     "-Inf", "+inf", "Infinity", "-infinity", "\u221e", "***",      "*",
        "missing", "null", "<NA>", "$-$",      "{-}",       "$--$",   "$\\infty$"};
    static const char *const present[] = {"0", "x", "-1", "nano", "* 1", "na na"};
    for (size_t i = 0; i < sizeof missing / sizeof *missing; i++)
        assert_true(br_field_is_missing(missing[i]));
    for (size_t i = 0; i < sizeof present / sizeof *present; i++)
        assert_false(br_field_is_missing(present[i]));
}

/* Too large a table is refused, and 10,000 rows are read. */
static const char *table_of(int rows, int columns)
{
    static char text[1 << 20];
    size_t used = 0;
    for (int i = 0; i <= rows; i++)
        for (int j = 0; j < columns; j++)
            used += (size_t)snprintf(text + used, sizeof text - used, i ? "%d%s" : "a%d%s", i + j,
                                     j + 1 < columns ? "," : "\n");
    return text;
}

static void refuse(const char *text, const char *why)
{
    OWNED(br_fields) fields;
    REFUSED(br_fields_read(text, "t", NULL, &fields, &err), BR_BAD_INPUT, why);
}

TEST(test_large_tables)
{
    struct br_fields fields;
    MUST(br_fields_read(table_of(10000, 4), "t", NULL, &fields, &err));
    assert_int_equal(fields.rows, 10000);
    assert_string_equal(fields.field[39999], "10003");
    br_fields_clear(&fields);
    refuse(table_of(10001, 2), "t:10002: found row 10001, expected at most 10000");
    refuse(table_of(41, 1000), "t:42: found row 41 of 1000 fields, expected at most 40000 fields");
    refuse(table_of(0, 1001), "t:1: found more than 1000 columns");
    refuse(table_of(2, 40000), "t:1: found more than 1000 columns");
}

TEST(test_many_left_aside)
{
    enum { SCALED = 40 };
    char text[2000] = "a = [1,2,3]\nb = [[1,2],[3,4],[5,6]]\n";
    OWNED(br_fields) fields;
    for (int i = 0; i < SCALED; i++)
        sprintf(text + strlen(text), "x%d = 2*[1,2,3]\n", i);
    MUST(br_fields_read(text, "t", NULL, &fields, &err));
    assert_int_equal(fields.lefts, SCALED + 1);
    assert_string_equal(fields.left[SCALED - 1].text, "x39 = 2*[1,2,3]");
    assert_string_equal(fields.left[SCALED].text, ": {\"a\":[\"1\",\"2\",\"3\"]}");
}

static bool always(__attribute__((unused)) void *self)
{
    return true;
}

TEST(test_interrupted)
{
    OWNED(br_fields) fields;
    const struct br_observer observer = {.stop = always};
    assert_int_equal(br_fields_read("h,e\n1,2\n", "t", &observer, &fields, &err), BR_INTERRUPTED);
}

static enum br_status whole(const void *text, struct br_error *why)
{
    OWNED(br_fields) fields;
    const enum br_status status = br_fields_read(text, "t", NULL, &fields, why);
    return status;
}

TEST(test_without_memory)
{
    br_test_without_memory(whole, "a b\nn e rate e rate\n8 1 - 1 -\n16 .2 2.0 .2 2.0\n", 8);
    br_test_without_memory(whole, "[{\"h\":0.1,\"e\":1},{\"h\":0.05,\"e\":2}]", 8);
    br_test_without_memory(whole, "h = [3,2,1]\ne = [3,2,1]\nf = 1./[3,2,1]\n", 8);
    br_test_without_memory(whole, "<tr><td rowspan=2>1<td>2<tr><td>3<tr><td>4<td>5", 8);
}
