#include <stdio.h>
#include <stdlib.h>
#include "study/study.h"
#include "study/scene_file.h"
int main(int c,char**a){ struct br_study st[2]={0}; struct br_scene sc[2]; struct br_error e={0}; char path[1000];
 size_t n[]={100,200,400,800,1600,3200}, s[]={100,200,500,1000,2000,10000};
 for(int i=0;i<2;i++){ if(br_scene_find(i?"example2":"example1",path,1000,&e)||br_scene_read(path,&sc[i],&e)){puts(e.message);return 2;}
  st[i].scene=&sc[i]; st[i].method=st[i].reference_method=br_method_default(); st[i].reference.n=atoi(a[2]); st[i].reference.steps=atoi(a[3]); st[i].n=n; st[i].steps=s; st[i].n_count=6; st[i].k_count=6; }
 if(br_study_run(st,2,atoi(a[1]),NULL,&e)){puts(e.message);return 3;}
 for(int i=0;i<2;i++) {printf("ref %.2f s\n",st[i].reference_seconds); for(int p=0;p<3;p++) for(int r=0;r<6;r++){ for(int k=0;k<6;k++) printf(" %.3e",br_study_cell(&st[i],r,k)->error[p]); puts("");}}
 (void)c; return 0;}
