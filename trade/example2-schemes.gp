# SPDX-License-Identifier: GPL-3.0-or-later
# What a digit costs: Example 2, slip
# Relative error against CPU seconds, by time scheme
# Draws example2-schemes.svg and example2-schemes.png from example2-schemes.dat;
# edit it, and draw them again, in this folder, with
#     gnuplot example2-schemes.gp

set encoding utf8
stem = 'example2-schemes'
data = stem.'.dat'
set datafile missing 'NaN'
set style line 102 lw 1 lc rgb '#d0d0d0' # grid

# The default font only scales marks; every text has its own size.
do for [format in 'svg png'] {
if (format eq 'svg') {
    set terminal svg size 1500,800 font 'DejaVu Sans,12' background rgb 'white'
    size = 0.75
    set pointintervalbox 1.6
} else {
    set terminal pngcairo size 1500,800 font 'DejaVu Sans,12' fontscale 0.75
    size = 1
    set pointintervalbox 1.7
}
set output stem.'.'.format
unset label
unset arrow
set lmargin at screen 0.1; set rmargin at screen 0.716
set bmargin at screen 0.13; set tmargin at screen 0.885
set logscale xy
set format '10^{%L}'
set grid xtics ytics ls 102
set xtics nomirror font ',21'; set ytics nomirror font ',21'
set xrange [4.68688e-05:0.139453]
set yrange [5.03931e-06:0.000129006]
set label 1 'CPU time of one thread, s' at screen 0.408,0.035 center font ',24'
set label 2 'relative error (31)' noenhanced at screen 0.022,0.5 center rotate font ',24'
set key at screen 0.724,0.885 left top Left reverse samplen 2.2 spacing 1.12 noenhanced font ',17'
set label 3 'What a digit costs: Example 2, slip' noenhanced at screen 0.02,0.96 left font ',24'
plot data index 0 using 1:2 with lines lw 12 lc rgb '#d8d8d8' title 'Pareto front', \
     data index 1 using 1:2 with points pt 7 ps 0.45*size lc rgb '#9a9a9a' title 'other trials', \
     data index 5 using 1:2 with linespoints lw 2 lc rgb '#0d0887' dt solid pt 7 ps 1.5*size title 'euler+implicit', \
     data index 6 using 1:2 with linespoints lw 2 lc rgb '#7d03a8' dt (12,4) pt 5 ps 1.5*size title 'esdirk4', \
     data index 7 using 1:2 with linespoints lw 2 lc rgb '#cb4679' dt (4,3) pt 9 ps 1.5*size title 'adaptive', \
     data index 8 using 1:2 with linespoints lw 2 lc rgb '#e8704f' dt (12,4,3,4) pt 13 ps 1.5*size title 'ida'
unset output
}
