# The stated bound of an error against the error, from the lines of tests/lab/map.
# usage: gnuplot -e 'cases="cases.txt"' docs/error.gp
set terminal pngcairo size 760,560 font 'DejaVu Sans,11'
set output 'docs/error.png'
set logscale xy
set format xy '10^{%T}'
set xrange [1e-9:10]
set yrange [1e-9:10]
set xlabel 'error of the answer, relative to the solution'
set ylabel 'stated bound'
set key right bottom
answers = "<awk '$7 == \"known\" { print $5, $6 == \"inf\" ? 9 : $6 }' " . cases
least(x) = x < 1e-9 ? 1e-9 : x
plot answers using (least($1)):(least($2)) \
         with points pt 6 ps 0.8 lc rgb '#444444' title 'an answer; at the top: "perhaps more than the solution"', \
     x with lines lw 2 lc rgb '#000000' title 'bound = error: an answer below is silently wrong', \
     10*x with lines dt 2 lc rgb '#777777' title 'bound = 10 times the error'
