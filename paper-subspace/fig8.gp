set datafile separator ','
set datafile missing 'nan'
set terminal svg noenhanced size 1200,900 font 'sans,13' background 'white'
set output 'fig8.svg'
compared = 'gen:hair-ball gen:curly-hair gen:straight-hair bathroom breakfast classroom kitchen ratboy-mohawk san-miguel sponza straight-hair'
others = 'gen:tilted-quads gen:foliage gen:tetra balls buddha bunny coffee-maker dutch-ship killeroo small-pine tetra'
set multiplot layout 2,2 margins 0.06,0.81,0.07,0.90 spacing 0.07,0.14 \
  title 'Fig. 8: object masks from nodes L levels below' font ',16'
set grid ytics lc rgb '#dddddd'
set xrange [0.8:6.2]
set xtics ('1' 1, '2' 2, '3' 3, '4' 4, '5' 5, 'unlimited' 6)
set xlabel 'L, levels'
set key at screen 0.995,0.9 right top samplen 2 font ',11'
array colors[12] = ['#1f77b4','#d62728','#2ca02c','#9467bd','#ff7f0e','#8c564b','#e377c2','#17becf','#bcbd22','#000000','#1a5276','#7d6608']
color(i) = colors[(i - 1) % 12 + 1]
do for [panel = 0:1] {
  do for [r = 4:6:2] {
    set ylabel panel == 0 ? 'intersections, % of no culling' : 'time to make the masks, L = 1 is 1'
    set title sprintf('R = %d', r)
    if (panel == 1 || r == 6) { unset key }
    c = panel == 0 ? 4 : 6
    plot for [i = 1:words(others)] 'fig8.csv' skip 1 using 3:(strcol(1) eq word(others, i) && $2 == r ? column(c) : NaN) \
           with lines lc rgb '#bbbbbb' title (i == 1 ? 'other scenes' : ''), \
         for [i = 1:words(compared)] 'fig8.csv' skip 1 using 3:(strcol(1) eq word(compared, i) && $2 == r ? column(c) : NaN) \
           with linespoints lw 1.5 ps 0.6 pt (i % 6 + 4) lc rgb color(i) title word(compared, i)
  }
}
unset multiplot
