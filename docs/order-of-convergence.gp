# Two meshes for one curve, and their errors over the mesh size.
# usage: gnuplot docs/order-of-convergence.gp
set terminal pngcairo size 1140,380 font 'DejaVu Sans,11'
set output 'docs/order-of-convergence.png'
set multiplot layout 1,3 margins 0.04,0.985,0.17,0.86 spacing 0.06
f(x) = sin(pi*x)
line(x, n) = (i = floor(x*n - 1e-12), a = i/n, b = (i + 1)/n, f(a) + (f(b) - f(a))*(x - a)*n)
set xrange [0:1]
set yrange [0:1.1]
set format y ''
unset key
set samples 401
do for [n in "4 8"] {
    set title n . ' pieces'
    plot f(x) lw 2 lc rgb '#999999', line(x, n*1.0) lw 2 lc rgb '#0072b2', \
         [0:n] '+' using (floor($1 + 0.5)*1.0/n):(f(floor($1 + 0.5)*1.0/n)) with points pt 7 lc rgb '#0072b2'
}
# The largest distance of the polygon from the curve: a piece [a, a + h] is off by most where f' is its slope.
slope(j, n) = (f((j + 1.0)/n) - f(j*1.0/n))*n
off(j, n) = (x = acos(slope(j, n)/pi)/pi, f(x) - line(x, n*1.0))
largest(n) = (m = 0, sum [j = 0:n/2 - 1] (m = off(j, n) > m ? off(j, n) : m, 0), m)
set title 'half the size, a quarter of the error: order 2'
set logscale xy
set xrange [0.014:0.35]
set yrange [3e-4:0.2]
set format x '%g'
set format y '10^{%T}'
set xlabel 'size of a piece'
set xtics (0.03125, 0.0625, 0.125, 0.25)
array n[4] = [4, 8, 16, 32]
plot n using (1.0/n[$1]):(largest(n[$1])) with linespoints lw 2 pt 7 ps 1.4 lc rgb '#0072b2', \
     n using (1.0/n[$1]):(largest(n[$1])):(sprintf('%.2g', largest(n[$1]))) with labels right offset -0.9,0.5
unset multiplot
